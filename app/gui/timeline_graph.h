// The graph of one animated parameter in the timeline.
#pragma once

#include "gui/timeline_state.h"

namespace astrosplat {

/// Of the parameter ViewState::graph_parameter, else of the first one animated.
void draw_graph(TimelineState& t, GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
