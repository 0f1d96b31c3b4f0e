#include "frame/frame_scene.h"

#include "core/parallel.h"
#include "scene/animate.h"

namespace astrosplat {

FrameScene frame_scene(const Scene& scene, double number, std::optional<Eye> eye) {
    FrameScene frame{number, scene_at(scene, number), {}, {}};
    if (eye) frame.scene.camera.eye = *eye;
    const CameraParams& camera = frame.scene.camera;
    const int count = frame.is_blurred() ? int(frame.scene.output.samples) : 0;
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

namespace {

constexpr std::int64_t chunk_values = 1 << 16;

void add(Image& sum, const Image& image) {
    parallel_each(sum.pixels.size(), chunk_values, [&](std::size_t i) { sum.pixels[i] += image.pixels[i]; });
}

void scale(Image& image, float factor) {
    parallel_each(image.pixels.size(), chunk_values, [&](std::size_t i) { image.pixels[i] *= factor; });
}

void multiply(Image& depth, const Image& opacity) {
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) depth.pixels[i] *= opacity.pixels[i];
}

void divide(Image& depth, const Image& opacity) {
    for (std::size_t i = 0; i < depth.pixels.size(); ++i)
        depth.pixels[i] = opacity.pixels[i] > 0.0f ? depth.pixels[i] / opacity.pixels[i] : 0.0f;
}

void add_layers(std::vector<Image>& sum, std::vector<Image>&& rendered, std::span<const std::size_t> layers) {
    for (std::size_t i = 0; i < rendered.size(); ++i) {
        if (sum.size() <= layers[i]) sum.resize(layers[i] + 1);
        Image& layer = sum[layers[i]];
        if (layer.pixels.empty())
            layer = std::move(rendered[i]);
        else
            add(layer, rendered[i]);
    }
}

}  // namespace

void add_rendering(RenderedFrame& sum, RenderedFrame&& rendering, std::span<const std::size_t> layers) {
    multiply(rendering.depth, rendering.opacity);
    add_layers(sum.layers, std::exchange(rendering.layers, {}), layers);
    if (sum.beauty.pixels.empty()) {
        std::vector<Image> summed = std::move(sum.layers);
        sum = std::move(rendering);
        sum.layers = std::move(summed);
        return;
    }
    using Frame = RenderedFrame;
    for (Image Frame::*image :
         {&Frame::beauty, &Frame::depth, &Frame::opacity, &Frame::coverage, &Frame::count})
        add(sum.*image, rendering.*image);
    RenderStatistics& statistics = sum.statistics;
    statistics.splats_in += rendering.statistics.splats_in;
    statistics.splats_drawn += rendering.statistics.splats_drawn;
    statistics.mean_overlap += rendering.statistics.mean_overlap;
    statistics.seconds += rendering.statistics.seconds;
    if (rendering.statistics.device.empty()) statistics.device.clear();
    if (!rendering.statistics.not_on_device.empty())
        statistics.not_on_device = rendering.statistics.not_on_device;
}

void divide_sum(RenderedFrame& sum, int n, std::size_t layer_count) {
    divide(sum.depth, sum.opacity);
    const float share = 1.0f / float(n);
    for (Image* image : {&sum.beauty, &sum.coverage, &sum.count}) scale(*image, share);
    sum.layers.resize(layer_count);
    for (Image& layer : sum.layers) {
        if (layer.pixels.empty()) layer = make_image(sum.beauty.width, sum.beauty.height, 4);
        scale(layer, share);
    }
    sum.statistics.splats_in /= n;
    sum.statistics.splats_drawn /= n;
    sum.statistics.mean_overlap /= n;
}

}  // namespace astrosplat
