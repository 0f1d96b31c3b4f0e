#include "render/scatter.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr std::int64_t slab_records = std::int64_t{1} << 20;
constexpr std::int64_t chunk_splats = 16384;
constexpr std::size_t flush_records = 65536;  // level of detail may turn a chunk into many more

ScreenRect rect_of(const TileGrid& grid) {
    return {static_cast<float>(grid.x0), static_cast<float>(grid.y0),
            static_cast<float>(grid.x0 + grid.width), static_cast<float>(grid.y0 + grid.height)};
}

float support_of(const LayerProjection& layer, const ScreenSplat& splat) {
    return splat.radius_px * layer.reach + layer.margin_px;
}

/// Whether a splat that touches a band is to be counted in it: by its centre, so that it counts once.
bool counts_here(const TileGrid& grid, float y_px) {
    return (grid.first_band || y_px >= static_cast<float>(grid.y0)) &&
           (grid.last_band || y_px < static_cast<float>(grid.y0 + grid.height));
}

}  // namespace

ScreenSplat* SplatStore::take(std::int64_t count) {
    const std::lock_guard lock(mutex_);
    while (slab_ < slabs_.size() && filled_ + count > static_cast<std::int64_t>(slabs_[slab_].size())) {
        ++slab_;
        filled_ = 0;
    }
    if (slab_ == slabs_.size()) slabs_.emplace_back(static_cast<std::size_t>(std::max(count, slab_records)));
    ScreenSplat* place = slabs_[slab_].data() + filled_;
    filled_ += count;
    return place;
}

void SplatStore::clear() {
    slab_ = 0;
    filled_ = 0;
}

void SplatStore::shrink(std::int64_t limit_bytes) {
    clear();
    while (!slabs_.empty() && bytes() > limit_bytes) slabs_.pop_back();
}

std::int64_t SplatStore::bytes() const {
    std::int64_t sum = 0;
    for (const Buffer<ScreenSplat>& slab : slabs_)
        sum += static_cast<std::int64_t>(slab.size() * sizeof(ScreenSplat));
    return sum;
}

TileBins::TileBins(const TileGrid& grid, int groups) : grid_(grid), groups_(groups) {
    std::int64_t columns = grid.columns(), rows = grid.rows();
    for (;;) {
        levels_.push_back({bins_per_group_, columns, rows});
        bins_per_group_ += columns * rows;
        if (columns == 1 && rows == 1) break;
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
    }
}

TileBins::BinRect TileBins::bins_of(const ScreenSplat& splat, float support_px, int group) const {
    float bins_per_px = 1.0f / static_cast<float>(grid_.tile_px), bin_px = static_cast<float>(grid_.tile_px);
    std::size_t number = 0;
    while (support_px > bin_px && number + 1 < levels_.size()) {
        bin_px *= 2.0f;
        bins_per_px *= 0.5f;
        ++number;
    }
    const Level& level = levels_[number];
    const auto bin = [&](float px,
                         std::int64_t count) {  // clamped first, so that rounding towards 0 is floor
        const float b = std::min(std::max(px * bins_per_px, 0.0f), static_cast<float>(count - 1));
        return static_cast<std::int32_t>(b);
    };
    const float x = splat.x_px - static_cast<float>(grid_.x0), y = splat.y_px - static_cast<float>(grid_.y0);
    return {group * bins_per_group_ + level.first_bin, static_cast<std::int32_t>(level.columns),
            bin(x - support_px, level.columns),        bin(y - support_px, level.rows),
            bin(x + support_px, level.columns),        bin(y + support_px, level.rows)};
}

/// Counting sort of a chunk's splats by bin, straight into the store. Empties scratch.splats.
void TileBins::add_segment(Scratch& scratch, const LayerProjection& layer, int group, SplatStore& store,
                           std::vector<Segment>& out) const {
    if (scratch.splats.empty()) return;
    Segment segment;
    std::int64_t last_bin = 0;
    segment.first_bin = static_cast<std::int64_t>(groups_) * bins_per_group_;
    scratch.rects.clear();
    for (const ScreenSplat& splat : scratch.splats) {
        const BinRect r = bins_of(splat, support_of(layer, splat), group);
        scratch.rects.push_back(r);
        segment.first_bin = std::min(segment.first_bin, r.first_bin + std::int64_t{r.y0} * r.columns + r.x0);
        last_bin = std::max(last_bin, r.first_bin + std::int64_t{r.y1} * r.columns + r.x1);
        if (!counts_here(grid_, splat.y_px)) continue;
        ++segment.instances;
        segment.footprint_px += real::pi * splat.radius_px * splat.radius_px;
    }
    const auto each_bin = [&](const BinRect& r, const auto& visit) {
        const std::int64_t corner = r.first_bin - segment.first_bin;
        for (std::int32_t y = r.y0; y <= r.y1; ++y)
            for (std::int32_t x = r.x0; x <= r.x1; ++x)
                visit(static_cast<std::size_t>(corner + std::int64_t{y} * r.columns + x));
    };
    std::vector<std::uint32_t>& offsets = segment.offsets;
    offsets.assign(static_cast<std::size_t>(last_bin - segment.first_bin + 2), 0);
    for (const BinRect& r : scratch.rects) each_bin(r, [&](std::size_t bin) { ++offsets[bin + 1]; });
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
    ScreenSplat* records = store.take(offsets.back());
    scratch.cursor.assign(offsets.begin(), offsets.end() - 1);
    for (std::size_t i = 0; i < scratch.splats.size(); ++i)
        each_bin(scratch.rects[i],
                 [&](std::size_t bin) { records[scratch.cursor[bin]++] = scratch.splats[i]; });
    segment.records = records;
    out.push_back(std::move(segment));
    scratch.splats.clear();
}

void TileBins::scatter(std::span<const LayerProjection> layers, std::span<const int> group_of_layer,
                       SplatStore& store, const Progress& progress) {
    struct Chunk {
        std::size_t layer;
        std::int64_t begin, end;
    };
    std::vector<Chunk> chunks;
    for (std::size_t l = 0; l < layers.size(); ++l)
        for (std::int64_t begin = 0; begin < layers[l].splats->size(); begin += chunk_splats)
            chunks.push_back({l, begin, std::min(begin + chunk_splats, layers[l].splats->size())});
    segments_.assign(chunks.size(), {});
    std::vector<Scratch> workers(static_cast<std::size_t>(thread_count()));
    const ScreenRect rect = rect_of(grid_);
    parallel_for(static_cast<std::int64_t>(chunks.size()), [&](std::int64_t c, int worker) {
        const Chunk& chunk = chunks[static_cast<std::size_t>(c)];
        const LayerProjection& layer = layers[chunk.layer];
        const int group = group_of_layer[chunk.layer];
        Scratch& scratch = workers[static_cast<std::size_t>(worker)];
        std::vector<Segment>& segments = segments_[static_cast<std::size_t>(c)];
        scratch.splats.clear();
        const std::int64_t step = layer.lod ? 16 : chunk_splats;  // children are flushed before they pile up
        for (std::int64_t begin = chunk.begin; begin < chunk.end; begin += step) {
            progress.check();
            project(layer, begin, std::min(begin + step, chunk.end), rect, scratch.splats);
            if (scratch.splats.size() >= flush_records) add_segment(scratch, layer, group, store, segments);
        }
        add_segment(scratch, layer, group, store, segments);
    });
}

void TileBins::collect(std::int64_t tile, int group, const Progress& progress,
                       std::vector<ScreenSplat>& out) const {
    out.clear();
    const std::int64_t column = tile % grid_.columns(), row = tile / grid_.columns();
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        const Level& level = levels_[l];
        const std::int64_t bin =
            group * bins_per_group_ + level.first_bin + (row >> l) * level.columns + (column >> l);
        for (const std::vector<Segment>& chunk : segments_) {
            progress.check();
            for (const Segment& segment : chunk) {
                const std::int64_t i = bin - segment.first_bin;
                if (i < 0 || i + 1 >= static_cast<std::int64_t>(segment.offsets.size())) continue;
                out.insert(out.end(), segment.records + segment.offsets[static_cast<std::size_t>(i)],
                           segment.records + segment.offsets[static_cast<std::size_t>(i + 1)]);
            }
        }
    }
}

std::int64_t TileBins::records() const {
    std::int64_t sum = 0;
    for (const std::vector<Segment>& chunk : segments_)
        for (const Segment& segment : chunk) sum += segment.offsets.back();
    return sum;
}

std::int64_t TileBins::instances() const {
    std::int64_t sum = 0;
    for (const std::vector<Segment>& chunk : segments_)
        for (const Segment& segment : chunk) sum += segment.instances;
    return sum;
}

double TileBins::footprint_px() const {
    double sum = 0.0;
    for (const std::vector<Segment>& chunk : segments_)
        for (const Segment& segment : chunk) sum += segment.footprint_px;
    return sum;
}

std::int64_t estimate_records(std::span<const LayerProjection> layers, const TileGrid& grid,
                              const Progress& progress) {
    constexpr std::int64_t block = 16, stride = 64 * block;
    const ScreenRect rect = rect_of(grid);
    double sum = 0.0;
    std::vector<ScreenSplat> splats;
    for (const LayerProjection& layer : layers) {
        std::int64_t sampled = 0;
        double records = 0.0;
        for (std::int64_t begin = 0; begin < layer.splats->size(); begin += stride) {
            progress.check();
            const std::int64_t end = std::min(begin + block, layer.splats->size());
            splats.clear();
            project(layer, begin, end, rect, splats);
            sampled += end - begin;
            for (const ScreenSplat& splat : splats) {
                const float tiles = 1.0f + 2.0f * support_of(layer, splat) / static_cast<float>(grid.tile_px);
                records += std::min(9.0f, tiles * tiles);
            }
        }
        if (sampled > 0)
            sum += records * static_cast<double>(layer.splats->size()) / static_cast<double>(sampled);
    }
    return static_cast<std::int64_t>(sum);
}

}  // namespace astrosplat
