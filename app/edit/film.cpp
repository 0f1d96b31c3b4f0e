#include "edit/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/frames.h"

namespace astrosplat {
namespace {

/// Of all keyframes; `otherwise` where there is none.
double last_keyframe(const Scene& scene, double otherwise) {
    double last = otherwise;
    for (const Track& track : scene.animation)
        for (const auto& keyframe : track.keyframes) last = std::max(last, keyframe.frame);
    return last;
}

}  // namespace

double film_frames(const OutputParams& output) {
    constexpr double seconds = 10.0;
    return std::fmax(1.0, std::floor(seconds * output.fps + 0.5));
}

void film_still(const Scene& before, Scene& after) {
    if (before.output.frames != after.output.frames) return;
    const std::vector<std::int64_t> frames = parse_frames(after.output.frames, "output.frames");
    const auto first = static_cast<double>(frames.front());
    if (frames.size() != 1 || last_keyframe(before, first) > first) return;
    const double last = last_keyframe(after, first);
    if (last > first)
        after.output.frames = fmt::format(
            "{}-{}", frames.front(), std::llround(std::max(first + film_frames(after.output) - 1.0, last)));
}

}  // namespace astrosplat
