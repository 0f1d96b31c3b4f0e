// How many splats a preview draws: in motion a budget that follows the measured time of a frame, at rest a
// few steps of more. Plain numbers in and out, no clock.
#pragma once

#include <cstdint>

namespace astrosplat {

/// Follows a target time, damped, and stays where it is within an eighth of the target: the frame's grain
/// changes under the eye with every move.
struct PreviewBudget {
    std::int64_t least = 30000, most = 4000000;  // splats
    std::int64_t splats = 200000;                // the budget

    /// Takes in one frame that drew `shown` splats in `milliseconds`. A frame that drew fewer than the
    /// budget, because no more are there, does not raise it.
    void measured(double milliseconds, double target_ms, std::int64_t shown);

  private:
    static constexpr int window = 5;  // frames
    double quickest_ms_ = 0.0;        // of the last frames since the budget moved
    int frames_ = 0;                  // of them
};

/// The time that a frame has left for its preview besides the rest of the window, which a software rasteriser
/// draws as slowly as the frame.
class FramePace {
  public:
    /// For the preview about to be drawn at `now_s`: what 24 frames a second leave of a frame, in ms, at
    /// least 10 and at most `most_ms`.
    double target_ms(double now_s, double most_ms);
    /// The preview took so long.
    void drew(double milliseconds) { preview_ms_ = milliseconds; }

  private:
    static constexpr int window = 8;  // frames
    double drawn_at_s_ = -1.0, preview_ms_ = 0.0;
    double rests_ms_[window] = {};  // of the last frames that followed each other, the oldest overwritten
    int rests_ = 0;
};

/// Steps before a final frame, and how long each may take, s.
struct StepPlan {
    int count = 0;
    double most_s = 0.0;
};
/// For a final frame that is expected to take so long; below 0: not known. A quick one is not held up by more
/// than the rest that comes before it anyway.
StepPlan plan_steps(double final_s);

/// Dots of a step that are worth drawing after `shown` of `total` splats took `seconds`, within most_s; 0:
/// none are. No limit where most_s is 0.
std::int64_t dots_of_step(int step, std::int64_t total, std::int64_t shown, double seconds, double most_s);

}  // namespace astrosplat
