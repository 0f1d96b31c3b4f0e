// The row of tools over the frame: from where it is seen, at what size, compared with what, and how shown.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

void draw_tool_row(GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
