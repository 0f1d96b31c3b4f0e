// One parameter, one row: label, value, unit, diamond; tooltip, menu and message. All of it follows from the
// parameter's description.
#pragma once

#include "gui/panel/box.h"

namespace astrosplat::panel {

/// Draws the row of a parameter.
void parameter_row(Context& context, const Parameter& parameter);

/// Where the parts of a row lie.
struct RowLayout {
    Area whole, label, value;
    ImVec2 diamond;  // its middle
};

struct Row {
    const Parameter& parameter;
    Value value;  // at the current frame
    RowLayout layout;
    const ParameterKey& key() const { return parameter.spec.key; }
};

inline constexpr float row_height = 24.0f, row_space = 2.0f;  // px at scale 1

}  // namespace astrosplat::panel
