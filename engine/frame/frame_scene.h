// A frame as one value: the scene at every moment that its shutter sees, and the mean of its renderings.
// Renderer, frame hash and writers all ask it, so that none of them knows more or less of the frame
// than the others.
#pragma once

#include "camera/camera.h"
#include "render/frame.h"
#include "scene/scene.h"

namespace astrosplat {

struct FrameScene {
    double number = 0.0;  // of the frame, real-valued
    Scene scene;          // at the frame's own time: what sizes, formats, names and matrices are asked of
    /// Of the renderings that the frame is the mean of, in the order in which they are added: at least one,
    /// that of an unblurred frame at its own time and through the middle of the lens.
    std::vector<CameraSample> samples;
    std::vector<Scene> moving;  // with an open shutter: the scene at each sample

    bool is_blurred() const { return astrosplat::is_blurred(scene.camera); }
    /// The scene as one of the samples sees it.
    const Scene& at_sample(std::size_t i) const { return moving.empty() ? scene : moving[i]; }
    /// Every scene that reaches the pixels.
    std::span<const Scene> moments() const {
        return moving.empty() ? std::span(&scene, 1) : std::span(moving);
    }
};

/// The frame of that number, with every track evaluated; `eye`: the one that it is seen with, whatever the
/// scene says.
FrameScene frame_scene(const Scene& scene, double number, std::optional<Eye> eye = {});

/// Indices of the layers that are visible at some moment, in file order.
std::vector<std::size_t> shown_layers(const FrameScene& frame);

/// Adds a rendering to the sum of those before it; an empty sum becomes the rendering. `layers`: which of the
/// frame's layers each of the rendering's is; the sum has images of those that came so far, empty ones of the
/// others. Depths are weighted by RenderedFrame::opacity, which has to be there with them.
void add_rendering(RenderedFrame& sum, RenderedFrame&& rendering, std::span<const std::size_t> layers);

/// Makes the sum of n renderings their mean, with an image for each of `layer_count` layers (0: none). Of the
/// statistics, counts and overlap are means and seconds a sum.
void divide_sum(RenderedFrame& sum, int n, std::size_t layer_count);

}  // namespace astrosplat
