// The list of layers: eye, colour, name, count, solo, holdout; order, names, additions.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// Draws the list over the width of the current window, `height` px at most; longer lists scroll.
void layer_list(Context& context, float height);

/// The plus with its menu, at the cursor.
void add_layer_button(Context& context);

/// Height the whole list would take, px.
float layer_list_height(const Context& context);

}  // namespace astrosplat::panel
