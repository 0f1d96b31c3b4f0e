// Plays a scene's frames. In: the time. Out: the view's frame.
#pragma once

#include "edit/view_state.h"
#include "scene/scene.h"

namespace astrosplat {

class Playback {
  public:
    /// Runs the frames of the scene round and round at its speed, dropping frames where drawing is slower.
    void advance(ViewState& view, const OutputParams& output, double now);

  private:
    double played_at_ = -1.0;  // seconds; below 0: it does not play
};

/// The first of [output] frames.
double first_frame(const Scene& scene);

}  // namespace astrosplat
