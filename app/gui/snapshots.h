// The strip of snapshots under the frame: a thumbnail, its name, splats and time of each; clicked it
// becomes B.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

void draw_snapshots(GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
