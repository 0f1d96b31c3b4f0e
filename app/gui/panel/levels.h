// Black and white point, dragged over the values of the picture.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// Spread of the picture's values; black and white are dragged on it.
void edit_levels(Context& context);

}  // namespace astrosplat::panel
