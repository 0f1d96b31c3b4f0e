// The one line under the tools: that the scene's file changed on disk, or the hint of the first start.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

void draw_notice(GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
