// Look: how the splats of the selected layer are thinned, faded, sized and coloured.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

void look_tab(Context& context);

/// The look's distance at which x = 1 for the selected layer, scene units; 0: not known.
double reach_of(const Context& context);

}  // namespace astrosplat::panel
