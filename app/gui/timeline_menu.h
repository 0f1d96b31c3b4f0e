// What is done to the selected keys of the timeline at once.
#pragma once

#include "gui/timeline_state.h"

namespace astrosplat {

void remove_selected(TimelineState& t, GuiFrame& frame);
/// The popup "key menu": interpolation, the ends of tracks, removal.
void draw_key_menu(TimelineState& t, GuiFrame& frame);

}  // namespace astrosplat
