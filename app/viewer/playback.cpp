#include "viewer/playback.h"

#include <cmath>
#include <vector>

#include "scene/frames.h"
#include "scene/load.h"

namespace astrosplat {

void Playback::advance(ViewState& view, const OutputParams& output, double now) {
    if (!view.playing) {
        played_at_ = -1.0;
        return;
    }
    if (played_at_ < 0.0) {
        played_at_ = now;
        return;
    }
    const double steps = std::floor((now - played_at_) * output.fps);
    if (steps < 1.0) return;
    const std::vector<std::int64_t> frames = parse_frames(output.frames, "output.frames");
    view.frame = std::floor(view.frame) + steps;
    if (view.frame > static_cast<double>(frames.back())) view.frame = static_cast<double>(frames.front());
    played_at_ += steps / output.fps;
}

double first_frame(const Scene& scene) {
    return static_cast<double>(parse_frames(scene.output.frames, "output.frames").front());
}

}  // namespace astrosplat
