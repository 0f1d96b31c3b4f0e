// The channels of an animated vector or colour: their names and colours, and which of them the graph shows.
#pragma once

#include <string>

#include "gui/gui_frame.h"
#include "scene/parameter.h"

namespace astrosplat {

/// "X", "G"; numbered from 1 where they have no names.
std::string channel_name(const ParameterSpec& spec, std::size_t channel);
/// x, y, z, w or r, g, b: told apart, not shouting. A lone channel has the text's.
unsigned channel_color(std::size_t channel, std::size_t count);
bool channel_hidden(const ViewState& view, const Track& track, std::size_t channel);

/// Px of the letters that draw_channels draws.
float channels_width(const Track& track);
/// A letter each, clicked to hide and show it; with Shift it alone is shown, or all again.
void draw_channels(GuiFrame& frame, const Track& track, const ParameterSpec& spec, float x, float y,
                   float height);

}  // namespace astrosplat
