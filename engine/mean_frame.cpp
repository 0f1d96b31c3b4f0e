#include "mean_frame.h"

#include <utility>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr std::int64_t chunk_values = 1 << 16;

void add(Image& sum, const Image& image) {
    parallel_chunks(std::ssize(sum.pixels), chunk_values, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin; i < end; ++i) sum.pixels[i] += image.pixels[i];
    });
}

void scale(Image& image, float factor) {
    parallel_chunks(std::ssize(image.pixels), chunk_values, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin; i < end; ++i) image.pixels[i] *= factor;
    });
}

void multiply_by_alpha(Image& depth, const Image& beauty) {
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) depth.pixels[i] *= beauty.pixels[4 * i + 3];
}

}  // namespace

void add_rendering(RenderedFrame& sum, RenderedFrame&& rendering) {
    multiply_by_alpha(rendering.depth, rendering.beauty);
    if (sum.beauty.pixels.empty()) {
        sum = std::move(rendering);
        return;
    }
    add(sum.beauty, rendering.beauty);
    add(sum.depth, rendering.depth);
    add(sum.coverage, rendering.coverage);
    add(sum.count, rendering.count);
    for (std::size_t l = 0; l < sum.layers.size(); ++l) add(sum.layers[l], rendering.layers[l]);
    sum.statistics.splats_drawn += rendering.statistics.splats_drawn;
    sum.statistics.mean_overlap += rendering.statistics.mean_overlap;
    sum.statistics.seconds += rendering.statistics.seconds;
}

void divide_sum(RenderedFrame& sum, int n) {
    for (std::size_t i = 0; i < sum.depth.pixels.size(); ++i) {
        const float alpha = sum.beauty.pixels[4 * i + 3];
        sum.depth.pixels[i] = alpha > 0.0f ? sum.depth.pixels[i] / alpha : 0.0f;
    }
    const float share = 1.0f / static_cast<float>(n);
    for (Image* image : {&sum.beauty, &sum.coverage, &sum.count}) scale(*image, share);
    for (Image& layer : sum.layers) scale(layer, share);
    sum.statistics.mean_overlap /= n;
}

}  // namespace astrosplat
