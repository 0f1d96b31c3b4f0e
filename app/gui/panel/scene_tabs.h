// Camera and Output: what belongs to the scene and not to a layer.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

void camera_tab(Context& context);
void output_tab(Context& context);

}  // namespace astrosplat::panel
