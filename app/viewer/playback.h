// Plays a scene's frames. In: the time. Out: the view's frame, and how many a second were reached.
#pragma once

#include <deque>

#include "edit/view_state.h"
#include "scene/scene.h"

namespace astrosplat {

class Playback {
  public:
    /// Runs the frames between the view's in and out points at the scene's speed: round and round, there and
    /// back, or once. Where drawing is slower, frames are dropped, or the speed with ViewState::every_frame.
    void advance(ViewState& view, const OutputParams& output, double now);
    /// Frames a second that were shown over the last second or so; 0 until that is known.
    double shown_fps() const;

  private:
    double next_frame(double frame, double steps, ViewState& view, const OutputParams& output);

    double played_at_ = -1.0;      // seconds; below 0: it does not play
    bool backwards_ = false;       // on the way back
    std::deque<double> shown_at_;  // seconds of the last frames
};

/// The first of [output] frames.
double first_frame(const Scene& scene);

}  // namespace astrosplat
