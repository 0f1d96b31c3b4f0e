// What is done to the selected keyframes of the timeline at once.
#pragma once

#include "gui/timeline_state.h"

namespace astrosplat {

void remove_selected(TimelineState& t, GuiFrame& frame);
/// The popup "keyframe menu": interpolation, the ends of tracks, removal.
void draw_keyframe_menu(TimelineState& t, GuiFrame& frame);

}  // namespace astrosplat
