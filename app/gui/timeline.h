// The timeline: ruler and playhead, the keyframes of every animated parameter, the graph of one of them. In:
// the scene's tracks. Out: the frame looked at, and edits of the tracks.
#pragma once

#include "gui/timeline_state.h"

namespace astrosplat {

/// Distance of ruler numbers in frames (1, 2, 5, 10, ...) that leaves them at least `least_px` apart.
double ruler_step(const TimeScale& scale, float least_px);

/// "dust: Power", "Camera: Position".
std::string track_label(const std::string& key, const ParameterSpec& spec);

class Timeline {
  public:
    void draw(GuiFrame& frame, const Rect& area);
    /// A keyframe or the playhead is being dragged.
    bool busy() const { return state_.drag != TimelineState::Drag::none; }

  private:
    TimelineState state_;
};

}  // namespace astrosplat
