#include "render/record_sample.h"

#include <algorithm>

#include "render/shape.h"

namespace astrosplat {
namespace {

/// Calls visit(layer, splats, shapes, how many splats each of these stands for) for a sample of all layers.
template <class Visit>
void sample_layers(std::span<const LayerProjection> layers, const TileGrid& grid, const Progress& progress,
                   const Visit& visit) {
    constexpr std::int64_t block = 16, stride = 64 * block;
    const ScreenRect rect = rect_of(grid);
    Buffer<ScreenSplat> splats;
    Buffer<Shape> shapes;
    const auto sample = [&](const LayerProjection& layer, std::int64_t begin, std::int64_t end, double each) {
        progress.check();
        splats.clear();
        shapes.clear();
        project(layer, begin, end, rect, splats, shapes);
        visit(layer, splats, shapes, each);
    };
    for (const LayerProjection& layer : layers) {
        if (layer.blocks) {
            LayerProjection here = layer;
            here.splats = &layer.blocks->sample();
            const std::vector<BlockFacts>& blocks = layer.blocks->blocks();
            for (std::size_t b = 0; b + 1 < blocks.size(); ++b) {
                const std::int64_t begin = blocks[b].first_sample, end = blocks[b + 1].first_sample;
                const double each = static_cast<double>(blocks[b].splats) /
                                    static_cast<double>(std::max<std::int64_t>(1, end - begin));
                for (std::int64_t i = begin; i < end; i += block)
                    sample(here, i, std::min(i + block, end), each);
            }
            continue;
        }
        const std::int64_t count = layer.splats->size(), rest = count % stride;
        const std::int64_t sampled = count / stride * block + std::min(rest, block);
        const double each =
            static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(1, sampled));
        for (std::int64_t begin = 0; begin < count; begin += stride)
            sample(layer, begin, std::min(begin + block, count), each);
    }
}

/// Records that a splat leaves in tiles of a size, about.
float records_of(const LayerProjection& layer, const ScreenSplat& splat, const Buffer<Shape>& shapes,
                 int tile_px) {
    const float tiles = 1.0f + 2.0f * support_px(layer, splat, shapes) / static_cast<float>(tile_px);
    return std::min(9.0f, tiles * tiles);
}

}  // namespace

std::vector<std::int64_t> estimate_records(std::span<const LayerProjection> layers, const TileGrid& grid,
                                           std::span<const int> tile_sizes_px, const Progress& progress) {
    std::vector<double> sums(tile_sizes_px.size(), 0.0);
    sample_layers(layers, grid, progress,
                  [&](const LayerProjection& layer, const auto& splats, const auto& shapes, double each) {
                      for (const ScreenSplat& splat : splats)
                          for (std::size_t t = 0; t < sums.size(); ++t)
                              sums[t] += each * records_of(layer, splat, shapes, tile_sizes_px[t]);
                  });
    std::vector<std::int64_t> records;
    for (const double sum : sums) records.push_back(static_cast<std::int64_t>(sum));
    return records;
}

DepthSample sample_depths(std::span<const LayerProjection> layers, const TileGrid& grid,
                          const Progress& progress) {
    DepthSample sample;
    sample_layers(
        layers, grid, progress,
        [&](const LayerProjection& layer, const auto& splats, const auto& shapes, double each) {
            for (const ScreenSplat& splat : splats)
                sample.shares.push_back({splat.depth, each * records_of(layer, splat, shapes, grid.tile_px)});
        });
    std::ranges::sort(sample.shares, {}, &DepthShare::depth);
    return sample;
}

}  // namespace astrosplat
