// The bar at the top: menus made of the table of actions, the scene's name in the middle.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

/// Draws into the current ImGui window, over `area`.
void draw_menu_bar(GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
