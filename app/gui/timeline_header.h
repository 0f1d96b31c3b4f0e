// The timeline's first row: playing, the frames and their rate, the graph.
#pragma once

#include "gui/timeline_state.h"

namespace astrosplat {

void draw_timeline_header(TimelineState& t, GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
