// What can be done with a layer's look as a whole.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// As buttons, or as items of a menu.
void look_buttons(Context& context);
void look_menu(Context& context);

}  // namespace astrosplat::panel
