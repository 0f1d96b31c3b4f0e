// Source: what the splats of the selected layer are made of.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

void source_tab(Context& context);

}  // namespace astrosplat::panel
