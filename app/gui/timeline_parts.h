// The parts of the timeline below its ruler: the rows of keyframes, one for every animated parameter, and the
// graph of one of them in their place, with its channels. In: the state of the timeline and the scene's
// tracks. Out: edits of these.
#pragma once

#include <string>

#include "gui/gui_frame.h"
#include "gui/timeline_state.h"
#include "scene/parameter.h"

namespace astrosplat {

/// The graph of the parameter ViewState::graph_parameter, else of the first one animated.
void draw_graph(TimelineState& t, GuiFrame& frame, const Rect& area);

/// "X", "G"; numbered from 1 where they have no names.
std::string channel_name(const ParameterSpec& spec, std::size_t channel);
/// x, y, z, w or r, g, b: told apart, not shouting. A lone channel has the text's.
unsigned channel_color(std::size_t channel, std::size_t count);
bool channel_hidden(const ViewState& view, const Track& track, std::size_t channel);

/// Width in px of the letters that draw_channels draws.
float channels_width(const Track& track);
/// A letter each, clicked to hide and show it; with Shift it alone is shown, or all again.
void draw_channels(GuiFrame& frame, const Track& track, const ParameterSpec& spec, float x, float y,
                   float height);

/// Width in px at the left of the keyframes and of the graph.
float names_width(const ViewState& view);
void draw_rows(TimelineState& t, GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
