#include "viewer/playback.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/frames.h"
#include "scene/load.h"

namespace astrosplat {
namespace {

struct PlayRange {
    double first, last;
};

/// Between the in and out points, where they lie within the frames.
PlayRange play_range(const ViewState& view, const OutputParams& output) {
    const std::vector<std::int64_t> frames = parse_frames(output.frames, "output.frames");
    const auto first = static_cast<double>(frames.front()), last = static_cast<double>(frames.back());
    PlayRange range{std::clamp(view.play_first.value_or(first), first, last),
                    std::clamp(view.play_last.value_or(last), first, last)};
    if (range.first > range.last) range.last = last;
    return range;
}

}  // namespace

double Playback::next_frame(double frame, double steps, ViewState& view, const OutputParams& output) {
    const auto [first, last] = play_range(view, output);
    if (frame < first || frame > last) return first;
    if (view.play_mode != PlayMode::ping_pong || first == last) {
        if (frame + steps <= last) return frame + steps;
        view.playing = view.play_mode != PlayMode::once;
        return view.playing ? first : last;
    }
    const double length = last - first;
    const double there = backwards_ ? 2.0 * length - (frame - first) : frame - first;
    const double at = std::fmod(there + steps, 2.0 * length);
    backwards_ = at >= length;
    return backwards_ ? last - (at - length) : first + at;
}

void Playback::advance(ViewState& view, const OutputParams& output, double now) {
    if (!view.playing) {
        played_at_ = -1.0;
        backwards_ = false;
        shown_at_.clear();
        return;
    }
    if (played_at_ < 0.0) {
        played_at_ = now;
        const PlayRange range = play_range(view, output);
        if (view.play_mode == PlayMode::once && view.frame >= range.last) view.frame = range.first;
        return;
    }
    const double due = std::floor((now - played_at_) * output.fps);
    if (due < 1.0) return;
    const double steps = view.every_frame ? 1.0 : due;
    view.frame = next_frame(std::floor(view.frame), steps, view, output);
    played_at_ = due > steps ? now : played_at_ + steps / output.fps;
    shown_at_.push_back(now);
    while (shown_at_.size() > 2 && now - shown_at_.front() > 1.0) shown_at_.pop_front();
}

double Playback::shown_fps() const {
    if (shown_at_.size() < 2) return 0.0;
    return static_cast<double>(shown_at_.size() - 1) / (shown_at_.back() - shown_at_.front());
}

double first_frame(const Scene& scene) {
    return static_cast<double>(parse_frames(scene.output.frames, "output.frames").front());
}

}  // namespace astrosplat
