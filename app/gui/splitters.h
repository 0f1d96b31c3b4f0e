// The two edges that can be dragged: of the side panel and of the timeline.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

/// Draws the lines between the parts and changes view.panel_width and view.timeline_height. Call it after the
/// parts, so that it lies over their edges.
void draw_splitters(GuiFrame& frame, const Layout& layout);

}  // namespace astrosplat
