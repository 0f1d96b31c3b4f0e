// Plots and notes that stand above or below the rows of some parameters and show what they mean.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// What belongs above, or below, the row of this parameter; nothing for most.
void draw_above(Context& context, const ParameterSpec& spec);
void draw_below(Context& context, const ParameterSpec& spec);

}  // namespace astrosplat::panel
