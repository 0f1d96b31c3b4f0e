// Render: dots, mixing and level of detail of the selected layer.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

void render_tab(Context& context);

}  // namespace astrosplat::panel
