// "Add move" where keyframes of the camera come later: asks what becomes of them.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

/// Asks for the move, or for the answer first.
void begin_move(GuiFrame& frame, CameraMove move);
void draw_move_dialog(GuiFrame& frame);

}  // namespace astrosplat
