#include "render/scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr std::int64_t slab_bytes = std::int64_t{40} << 20;
constexpr std::int64_t chunk_splats = 8192;   // with their records they fit a core's cache
constexpr std::int64_t most_bins = 9;         // of one splat, see bins_of
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

std::byte* SplatStore::take_bytes(std::int64_t bytes) {
    constexpr std::int64_t line = 64;
    const std::int64_t needed = (bytes + line - 1) / line * line;
    const std::lock_guard lock(mutex_);
    while (slab_ < slabs_.size() && filled_ + needed > static_cast<std::int64_t>(slabs_[slab_].size())) {
        ++slab_;
        filled_ = 0;
    }
    if (slab_ == slabs_.size()) slabs_.emplace_back(static_cast<std::size_t>(std::max(needed, slab_bytes)));
    std::byte* place = slabs_[slab_].data() + filled_;
    filled_ += needed;
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
    for (const Buffer<std::byte>& slab : slabs_) sum += static_cast<std::int64_t>(slab.size());
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

/// The bins that a splat's square of support touches. A level is chosen whose bins are at least as wide as
/// the support, so they are at most three by three.
TileBins::BinRect TileBins::bins_of(const ScreenSplat& splat, float support_px, int group) const {
    float bins_per_px = 1.0f / static_cast<float>(grid_.tile_px), bin_px = static_cast<float>(grid_.tile_px);
    std::size_t number = 0;
    while (support_px > bin_px && number + 1 < levels_.size()) {
        bin_px *= 2.0f;
        bins_per_px *= 0.5f;
        ++number;
    }
    const Level& level = levels_[number];
    const auto bin = [&](float px, std::int64_t count) {  // clamped first: rounding towards 0 is then floor
        const float b = std::min(std::max(px * bins_per_px, 0.0f), static_cast<float>(count - 1));
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(b));
    };
    const float x = splat.x_px - static_cast<float>(grid_.x0), y = splat.y_px - static_cast<float>(grid_.y0);
    const std::uint32_t x0 = bin(x - support_px, level.columns), y0 = bin(y - support_px, level.rows);
    const auto columns = static_cast<std::uint32_t>(level.columns);
    return {static_cast<std::uint32_t>(group * bins_per_group_ + level.first_bin) + y0 * columns + x0,
            columns, bin(x + support_px, level.columns) - x0 + 1, bin(y + support_px, level.rows) - y0 + 1};
}

/// Fills scratch.entries with the bins of scratch.splats; returns how many. Sets the segment's bins and sums.
std::int64_t TileBins::list_entries(Scratch& scratch, const LayerProjection& layer, int group,
                                    Segment& segment) const {
    scratch.entries.resize(scratch.splats.size() * most_bins);
    Entry* end = scratch.entries.data();
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), last = 0;
    for (std::size_t i = 0; i < scratch.splats.size(); ++i) {
        const ScreenSplat& splat = scratch.splats[i];
        const auto number = static_cast<std::uint32_t>(i);
        const BinRect r = bins_of(splat, support_of(layer, splat), group);
        first = std::min(first, r.first_bin);
        last = std::max(last, r.first_bin + (r.high - 1) * r.columns + r.wide - 1);
        if (r.wide <= 2 && r.high <= 2) {  // nearly always: without branches that cannot be foretold
            const std::uint32_t two_wide = r.wide - 1, two_high = r.high - 1;
            *end++ = {r.first_bin, number};
            *end = {r.first_bin + 1, number}, end += two_wide;
            *end = {r.first_bin + r.columns, number}, end += two_high;
            *end = {r.first_bin + r.columns + 1, number}, end += two_wide & two_high;
        } else {
            for (std::uint32_t y = 0; y < r.high; ++y)
                for (std::uint32_t x = 0; x < r.wide; ++x) *end++ = {r.first_bin + y * r.columns + x, number};
        }
        if (!counts_here(grid_, splat.y_px)) continue;
        ++segment.instances;
        segment.footprint_px += real::pi * splat.radius_px * splat.radius_px;
    }
    segment.first_bin = first;
    segment.bins = std::int64_t{last} - first + 1;
    return end - scratch.entries.data();
}

/// Counting sort of a chunk's splats by bin, straight into the store. Empties scratch.splats.
void TileBins::add_segment(Scratch& scratch, const LayerProjection& layer, int group, SplatStore& store,
                           std::vector<Segment>& out) const {
    if (scratch.splats.empty()) return;
    Segment segment;
    const std::int64_t count = list_entries(scratch, layer, group, segment);
    const std::span<const Entry> entries(scratch.entries.data(), static_cast<std::size_t>(count));
    const auto first = static_cast<std::uint32_t>(segment.first_bin);
    std::vector<std::uint32_t>& cursor = scratch.cursor;
    cursor.assign(static_cast<std::size_t>(segment.bins), 0);
    for (const Entry& e : entries) ++cursor[e.bin - first];
    auto* offsets = store.take<std::uint32_t>(segment.bins + 1);
    offsets[0] = 0;
    for (std::size_t i = 0; i < cursor.size(); ++i) {
        offsets[i + 1] = offsets[i] + cursor[i];
        cursor[i] = offsets[i];
    }
    auto* records = store.take<ScreenSplat>(count);
    // The store's lines are asked for one after the other: the writes come in no order, and would wait for
    // each.
    for (std::int64_t i = 0; i < count; ++i) __builtin_prefetch(records + i, 1);
    for (const Entry& e : entries) records[cursor[e.bin - first]++] = scratch.splats[e.splat];
    segment.offsets = offsets;
    segment.records = records;
    out.push_back(segment);
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
                       std::vector<std::span<const ScreenSplat>>& out) const {
    out.clear();
    const std::int64_t column = tile % grid_.columns(), row = tile / grid_.columns();
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        const Level& level = levels_[l];
        const std::int64_t bin =
            group * bins_per_group_ + level.first_bin + (row >> l) * level.columns + (column >> l);
        for (std::size_t c = 0; c < segments_.size(); ++c) {
            if (c % 64 == 0) progress.check();
            for (const Segment& segment : segments_[c]) {
                const std::int64_t i = bin - segment.first_bin;
                if (i < 0 || i >= segment.bins) continue;
                const std::uint32_t begin = segment.offsets[i], end = segment.offsets[i + 1];
                if (end > begin) out.emplace_back(segment.records + begin, end - begin);
            }
        }
    }
}

std::int64_t TileBins::records() const {
    std::int64_t sum = 0;
    for (const std::vector<Segment>& chunk : segments_)
        for (const Segment& segment : chunk) sum += segment.offsets[segment.bins];
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
