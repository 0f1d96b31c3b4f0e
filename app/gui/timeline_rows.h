// The rows of the timeline: one for every animated parameter, its keyframes as diamonds; or its graph in
// their place.
#pragma once

#include "gui/timeline_state.h"

namespace astrosplat {

/// Px at the left of the keyframes and of the graph.
float names_width(const ViewState& view);
void draw_rows(TimelineState& t, GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
