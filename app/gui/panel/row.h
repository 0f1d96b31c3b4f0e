// One parameter, one row: label, value, unit, diamond; tooltip, menu and message. All of it follows from the
// parameter's description.
#pragma once

#include "gui/panel/box.h"

namespace astrosplat::panel {

/// Draws the row of a full key; nothing where there is no such parameter. `label` replaces the described one
/// where the section's head says it already.
void parameter_row(Context& context, const std::string& key, const char* label = nullptr);

/// The same for a key of the selected layer: "look.alpha.power".
void layer_row(Context& context, const std::string& key, const char* label = nullptr);

/// Where the parts of a row lie.
struct RowLayout {
    Area whole, label, value;
    ImVec2 diamond;  // its middle
};

/// The next row's, at the cursor.
RowLayout next_row();

struct Row {
    const Parameter& parameter;
    Value value;  // at the current frame
    RowLayout layout;
    std::string key() const { return parameter.spec.key; }
};

/// Label, tick and diamond; and, after the value was drawn, menu, tooltip and message. Leaves the cursor
/// below.
void begin_row(Context& context, const Row& row, const std::string& label);
void end_row(Context& context, const Row& row);

/// Diamond of a parameter that a plot shows instead of a row; also notes it as drawn. `where`: the plot.
void draw_diamond(Context& context, const Row& row);
void note_row(Context& context, const Row& row);

inline constexpr float row_height = 24.0f, row_gap = 2.0f;  // px at scale 1

}  // namespace astrosplat::panel
