// The quickest of a few frames counts, because what disturbs a frame (a cut, another program) only ever makes
// it slower.
#include "viewer/preview_budget.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace astrosplat {
namespace {

/// The share of the splats that step 1, 2 .. draws; 0: there is no such step.
double share_of_step(int step) {
    constexpr double shares[] = {0.05, 0.2};
    return step >= 1 && step <= static_cast<int>(std::size(shares)) ? shares[step - 1] : 0.0;
}

}  // namespace

void PreviewBudget::measured(double milliseconds, double target_ms, std::int64_t shown) {
    constexpr double dead_zone = 1.0 / 8.0, far_off = 2.0;
    quickest_ms_ = frames_ == 0 ? milliseconds : std::min(quickest_ms_, milliseconds);
    ++frames_;
    const double wanted =
        target_ms / std::max(quickest_ms_, 1e-3);  // times as many, were all costs per splat
    const bool waits = frames_ < window && !(wanted * far_off < 1.0 && frames_ >= 2);
    if (waits) return;
    frames_ = 0;
    if (std::fabs(wanted - 1.0) <= dead_zone) return;
    if (wanted > 1.0 && shown < splats - splats / 8) return;
    const double factor = std::clamp(std::sqrt(wanted), 0.5, 1.5);
    const double moved = static_cast<double>(splats) * factor;
    splats = std::clamp(static_cast<std::int64_t>(moved), least, most);
}

double FramePace::target_ms(double now_s, double most_ms) {
    constexpr double frame_ms = 1000.0 / 24.0, least_ms = 10.0, pause_ms = 200.0;
    const double rest_ms = 1000.0 * (now_s - drawn_at_s_) - preview_ms_;
    const bool follows = drawn_at_s_ >= 0.0 && rest_ms >= 0.0 && rest_ms < pause_ms;
    drawn_at_s_ = now_s;
    if (!follows) rests_ = 0;
    if (follows) rests_ms_[rests_++ % window] = rest_ms;
    // The quickest, because a slow hand waits between frames too.
    const int count = std::min(rests_, window);
    const double quickest = count > 0 ? *std::min_element(rests_ms_, rests_ms_ + count) : 0.0;
    return std::clamp(frame_ms - quickest, std::min(least_ms, most_ms), most_ms);
}

StepPlan plan_steps(double final_s) {
    constexpr double at_once_s = 0.3, quick_s = 2.5;
    if (0.0 <= final_s && final_s < at_once_s) return {};
    if (0.0 <= final_s && final_s < quick_s) return {1, 0.08};
    return {2, 0.4};
}

std::int64_t dots_of_step(int step, std::int64_t total, std::int64_t shown, double seconds, double most_s) {
    constexpr double least_gain = 1.5;
    double dots = share_of_step(step) * static_cast<double>(total);
    const double most = static_cast<double>(shown) * (most_s > 0.0 && seconds > 0.0 ? most_s / seconds : 1e9);
    dots = std::min(dots, most);
    return dots < least_gain * static_cast<double>(shown) ? 0 : std::llround(dots);
}

}  // namespace astrosplat
