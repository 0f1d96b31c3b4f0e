// The list of layers: eye, colour, name, count, solo, holdout; order, names, additions.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// Draws the list over the width of the current window, `height` px at most; longer lists scroll.
void layer_list(Context& context, float height);

/// Height the whole list would take, px.
float layer_list_height(const Context& context);

}  // namespace astrosplat::panel
