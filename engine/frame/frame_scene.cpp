#include "frame/frame_scene.h"

#include <algorithm>

#include "scene/animate.h"

namespace astrosplat {

FrameScene frame_scene(const Scene& scene, double number, std::optional<Eye> eye) {
    FrameScene frame{number, scene_at(scene, number), {}, {}};
    if (eye) frame.scene.camera.eye = *eye;
    const CameraParams& camera = frame.scene.camera;
    const int count = frame.is_blurred() ? static_cast<int>(frame.scene.output.samples) : 0;
    for (int i = 0; i < count; ++i) frame.samples.push_back(camera_sample(camera, i, count));
    if (frame.samples.empty()) frame.samples.emplace_back();
    if (!(camera.shutter > 0.0)) return frame;
    for (const CameraSample& sample : frame.samples) {
        frame.moving.push_back(sample.frames == 0.0 ? frame.scene : scene_at(scene, number + sample.frames));
        if (eye) frame.moving.back().camera.eye = *eye;
    }
    return frame;
}

std::vector<std::size_t> shown_layers(const FrameScene& frame) {
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < frame.scene.layers.size(); ++i)
        if (std::ranges::any_of(frame.moments(), [&](const Scene& s) { return s.layers[i].visible; }))
            shown.push_back(i);
    return shown;
}

}  // namespace astrosplat
