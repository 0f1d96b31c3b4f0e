#include "render/scatter.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/real.h"
#include "render/shape.h"

namespace astrosplat {
namespace {

constexpr std::int64_t slab_bytes = std::int64_t{40} << 20, line_bytes = 64;
constexpr std::int64_t chunk_splats = 8192;  // handed out to a worker
constexpr std::int64_t step_splats = 512;    // projected before they are written: they stay in cache

ScreenRect rect_of(const TileGrid& grid) {
    return {static_cast<float>(grid.x0), static_cast<float>(grid.y0),
            static_cast<float>(grid.x0 + grid.width), static_cast<float>(grid.y0 + grid.height)};
}

/// Whether a splat that touches a band is to be counted in it: by its centre, so that it counts once.
bool counts_here(const TileGrid& grid, float y_px) {
    return (grid.first_band || y_px >= static_cast<float>(grid.y0)) &&
           (grid.last_band || y_px < static_cast<float>(grid.y0 + grid.height));
}

}  // namespace

std::byte* SplatStore::take_bytes(std::int64_t bytes) {
    const std::int64_t needed = (bytes + line_bytes - 1) / line_bytes;
    const std::lock_guard lock(mutex_);
    while (slab_ < slabs_.size() && filled_ + needed > std::ssize(slabs_[slab_])) {
        ++slab_;
        filled_ = 0;
    }
    if (slab_ == slabs_.size())
        slabs_.emplace_back(static_cast<std::size_t>(std::max(needed, slab_bytes / line_bytes)));
    std::byte* place = slabs_[slab_][static_cast<std::size_t>(filled_)].bytes;
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
    for (const Buffer<CacheLine>& slab : slabs_) sum += std::ssize(slab) * line_bytes;
    return sum;
}

TileBins::TileBins(const TileGrid& grid, int groups, std::int64_t expected_records)
    : grid_(grid), groups_(groups) {
    std::int64_t columns = grid.columns(), rows = grid.rows();
    for (;;) {
        levels_.push_back({static_cast<std::uint32_t>(bins_per_group_), static_cast<std::uint32_t>(columns),
                           static_cast<float>(columns - 1), static_cast<float>(rows - 1)});
        bins_per_group_ += columns * rows;
        if (columns == 1 && rows == 1) break;
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
    }
    // The last block of each bin and worker is half empty on average: an eighth of the memory at most.
    const std::int64_t writers_bins = std::max<std::int64_t>(1, bins() * thread_count());
    block_records_ = std::clamp<std::int64_t>(expected_records / (4 * writers_bins), 8, 128);
}

/// Adds the splats just projected to the sums over their chunk.
void TileBins::sum_up(const Writer& writer, Sums& sums) const {
    Sums sum = sums;  // in registers
    const bool all_round = writer.shapes.empty();
    for (const ScreenSplat& splat : writer.splats) {
        if (!all_round && !is_round(splat)) {
            add_shape(writer.shapes[shape_number(splat)], splat.y_px, sum);
            continue;
        }
        sum.least_px = std::min(sum.least_px, splat.radius_px);
        sum.largest_px = std::max(sum.largest_px, splat.radius_px);
        if (!counts_here(grid_, splat.y_px)) continue;
        ++sum.instances;
        sum.footprint_px += real::pi * splat.radius_px * splat.radius_px;
    }
    sums = sum;
}

/// The same for one that is not round.
void TileBins::add_shape(const Shape& shape, float y_px, Sums& sum) const {
    const NodeRange nodes = node_range(shape);
    const ShapeRadii radii = shape_radii(shape);
    sum.least_px = std::min(sum.least_px, nodes.least_px);
    sum.largest_px = std::max(sum.largest_px, nodes.largest_px);
    if (!counts_here(grid_, y_px)) return;
    ++sum.instances;
    sum.footprint_px += real::pi * radii.larger * radii.smaller;
}

/// The bins of the splats just projected.
std::span<const TileBins::Entry> TileBins::list_entries(const LayerProjection& layer, int group,
                                                        Writer& writer) const {
    const std::size_t count = writer.splats.size();
    writer.discs.resize(count + bin_rect_room);
    writer.rects.resize(count + bin_rect_room);
    writer.entries.resize(count * most_bins);
    for (std::size_t i = 0; i < count; ++i) {
        const ScreenSplat& splat = writer.splats[i];
        writer.discs.set(i, splat.x_px, splat.y_px, support_px(layer, splat, writer.shapes));
    }
    find_bins({static_cast<float>(grid_.x0), static_cast<float>(grid_.y0), static_cast<float>(grid_.tile_px),
               levels_},
              writer.discs, count, writer.rects.data());
    const auto group_bin = static_cast<std::uint32_t>(group * bins_per_group_);
    const BinRect* const rects = writer.rects.data();
    Entry* end = writer.entries.data();
    for (std::uint32_t i = 0; i < count; ++i) {
        const BinRect r = rects[i];
        const std::uint32_t first = group_bin + r.first_bin;
        if (r.wide <= 2 && r.high <= 2) {  // nearly always: without unpredictable branches
            const std::uint32_t two_wide = r.wide - 1, two_high = r.high - 1;
            *end++ = {first, i};
            *end = {first + 1, i}, end += two_wide;
            *end = {first + r.columns, i}, end += two_high;
            *end = {first + r.columns + 1, i}, end += two_wide & two_high;
        } else {
            for (std::uint32_t y = 0; y < r.high; ++y)
                for (std::uint32_t x = 0; x < r.wide; ++x) *end++ = {first + y * r.columns + x, i};
        }
    }
    return {writer.entries.data(), end};
}

void TileBins::begin_block(std::uint32_t bin, SplatStore& store, Writer& writer) const {
    constexpr std::int64_t blocks_at_once = 64;  // the store is shared
    if (writer.unused == writer.unused_end) {
        writer.unused = store.take<ScreenSplat>(blocks_at_once * block_records_);
        writer.unused_end = writer.unused + blocks_at_once * block_records_;
    }
    writer.cursors[bin] = {writer.unused, writer.unused + block_records_};
    writer.blocks.push_back({writer.unused, bin});
    writer.unused += block_records_;
}

void TileBins::write(std::span<const Entry> entries, SplatStore& store, Writer& writer) const {
    constexpr int ahead = 4;  // records: writes that miss the cache would wait for each other
    for (const Entry& e : entries) {
        Writer::Cursor& cursor = writer.cursors[e.bin];
        if (cursor.next == cursor.end) begin_block(e.bin, store, writer);
        __builtin_prefetch(cursor.next + ahead, 1);
        *cursor.next++ = writer.splats[e.splat];
    }
}

/// Sets shapes_: each writer's after those of the writers before, with their numbers in its records.
void TileBins::join_shapes(std::span<const Writer> writers) {
    shapes_.clear();
    for (const Writer& writer : writers) {
        const auto first = static_cast<std::uint32_t>(shapes_.size());
        for (const Shape& shape : writer.shapes) shapes_.push_back(shape);
        if (first == 0 || writer.shapes.empty()) continue;
        for (const Block& block : writer.blocks)
            for (ScreenSplat& splat : records_of(writer, block))
                if (!is_round(splat)) set_shape_number(splat, shape_number(splat) + first);
    }
}

/// The records written into a block.
std::span<ScreenSplat> TileBins::records_of(const Writer& writer, const Block& block) const {
    const Writer::Cursor& last = writer.cursors[block.bin];
    ScreenSplat* const end = block.records + block_records_;
    return {block.records, last.end == end ? last.next : end};
}

/// Sets blocks_ and first_block_.
void TileBins::sort_blocks(std::span<const Writer> writers) {
    first_block_.assign(static_cast<std::size_t>(bins()) + 1, 0);
    for (const Writer& writer : writers)
        for (const Block& block : writer.blocks) ++first_block_[block.bin + 1];
    for (std::size_t b = 1; b < first_block_.size(); ++b) first_block_[b] += first_block_[b - 1];
    blocks_.resize(first_block_.back());
    std::vector<std::size_t> next = first_block_;
    for (const Writer& writer : writers)
        for (const Block& block : writer.blocks) blocks_[next[block.bin]++] = records_of(writer, block);
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
    sums_.assign(chunks.size(), {});
    std::vector<Writer> writers(static_cast<std::size_t>(thread_count()));
    for (Writer& writer : writers) writer.cursors.resize(bins());
    const ScreenRect rect = rect_of(grid_);
    parallel_for(static_cast<std::int64_t>(chunks.size()), [&](std::int64_t c, int worker) {
        const Chunk& chunk = chunks[c];
        const LayerProjection& layer = layers[chunk.layer];
        const int group = group_of_layer[chunk.layer];
        Writer& writer = writers[worker];
        // Level of detail may turn a splat into thousands.
        const std::int64_t step = layer.lod ? 16 : step_splats;
        for (std::int64_t begin = chunk.begin; begin < chunk.end; begin += step) {
            progress.check();
            writer.splats.clear();
            project(layer, begin, std::min(begin + step, chunk.end), rect, writer.splats, writer.shapes);
            sum_up(writer, sums_[c]);
            write(list_entries(layer, group, writer), store, writer);
        }
    });
    join_shapes(writers);
    sort_blocks(writers);
}

void TileBins::collect(std::int64_t tile, int group, std::vector<std::span<const ScreenSplat>>& out) const {
    out.clear();
    const std::int64_t column = tile % grid_.columns(), row = tile / grid_.columns();
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        const BinLevel& level = levels_[l];
        const std::int64_t bin =
            group * bins_per_group_ + level.first_bin + (row >> l) * level.columns + (column >> l);
        const auto at = [&](std::int64_t b) {
            return blocks_.begin() + static_cast<std::ptrdiff_t>(first_block_[b]);
        };
        out.insert(out.end(), at(bin), at(bin + 1));
    }
}

TileBins::Sums TileBins::sums() const {
    Sums all;
    for (const Sums& chunk : sums_) {
        all.instances += chunk.instances;
        all.footprint_px += chunk.footprint_px;
        all.least_px = std::min(all.least_px, chunk.least_px);
        all.largest_px = std::max(all.largest_px, chunk.largest_px);
    }
    return all;
}

std::vector<std::int64_t> estimate_records(std::span<const LayerProjection> layers, const TileGrid& grid,
                                           std::span<const int> tile_sizes_px, const Progress& progress) {
    constexpr std::int64_t block = 16, stride = 64 * block;
    const ScreenRect rect = rect_of(grid);
    std::vector<double> sums(tile_sizes_px.size(), 0.0);
    Buffer<ScreenSplat> splats;
    Buffer<Shape> shapes;
    for (const LayerProjection& layer : layers) {
        const std::int64_t count = layer.splats->size();
        std::vector<double> found(tile_sizes_px.size(), 0.0);
        std::int64_t sampled = 0;
        for (std::int64_t begin = 0; begin < count; begin += stride) {
            progress.check();
            const std::int64_t end = std::min(begin + block, count);
            splats.clear();
            shapes.clear();
            project(layer, begin, end, rect, splats, shapes);
            sampled += end - begin;
            for (const ScreenSplat& splat : splats)
                for (std::size_t t = 0; t < found.size(); ++t) {
                    const float tiles =
                        1.0f + 2.0f * support_px(layer, splat, shapes) / static_cast<float>(tile_sizes_px[t]);
                    found[t] += std::min(9.0f, tiles * tiles);
                }
        }
        for (std::size_t t = 0; t < found.size() && sampled > 0; ++t)
            sums[t] += found[t] * static_cast<double>(count) / static_cast<double>(sampled);
    }
    std::vector<std::int64_t> records;
    for (const double sum : sums) records.push_back(static_cast<std::int64_t>(sum));
    return records;
}

}  // namespace astrosplat
