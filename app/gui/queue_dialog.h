// The queue of renderings: a dialog that shows Status::jobs, with the finished frames of one of them.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

void draw_queue(GuiFrame& frame);

/// "2:05", "1:02:05".
std::string duration_text(double seconds);

}  // namespace astrosplat
