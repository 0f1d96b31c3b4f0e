#include "render/scatter.h"

#include <numeric>

#include "core/parallel.h"
#include "core/real.h"
#include "render/shape.h"

namespace astrosplat {
namespace {

constexpr std::int64_t slab_bytes = std::int64_t{40} << 20, line_bytes = 64;
constexpr std::int64_t chunk_splats = 8192;  // handed out to a worker
constexpr std::int64_t least_block = 8;      // records
constexpr std::int64_t step_splats = 512;    // projected before they are written: they stay in cache
constexpr std::size_t step_rest = 16;        // of those that may become thousands

/// Drops those that lie in other slabs, and their shapes, which begin at `first_shape`.
void keep_in_slab(const DepthRange& slab, std::size_t first_shape, Buffer<ScreenSplat>& splats,
                  Buffer<Shape>& shapes) {
    std::erase_if(splats, [&](const ScreenSplat& splat) { return !slab.holds(splat.depth); });
    if (shapes.size() == first_shape) return;
    std::size_t end = first_shape;
    std::uint32_t last = 0xffffffffu;  // shape, before
    for (ScreenSplat& splat : splats) {
        if (is_round(splat)) continue;
        const std::uint32_t number = shape_number(splat);
        if (number != last) shapes[end++] = shapes[number];
        last = number;
        set_shape_number(splat, std::uint32_t(end - 1));
    }
    shapes.resize(end);
}

/// Whether a splat that touches a band is to be counted in it: by its centre, so that it counts once.
bool counts_here(const TileGrid& grid, float y_px) {
    return (grid.first_band || y_px >= float(grid.y0)) &&
           (grid.last_band || y_px < float(grid.y0 + grid.height));
}

}  // namespace

ScreenRect rect_of(const TileGrid& grid) {
    return {float(grid.x0), float(grid.y0), float(grid.x0 + grid.width), float(grid.y0 + grid.height)};
}

std::byte* SplatStore::take_bytes(std::int64_t bytes) {
    const std::int64_t needed = (bytes + line_bytes - 1) / line_bytes;
    const std::lock_guard lock(mutex_);
    if (limit_ > 0 && used_ + needed * line_bytes > limit_) throw StoreFull();
    used_ += needed * line_bytes;
    while (slab_ < slabs_.size() && filled_ + needed > std::ssize(slabs_[slab_])) {
        ++slab_;
        filled_ = 0;
    }
    if (slab_ == slabs_.size()) slabs_.emplace_back(std::size_t(std::max(needed, slab_bytes / line_bytes)));
    std::byte* place = slabs_[slab_][filled_].bytes;
    filled_ += needed;
    return place;
}

void SplatStore::clear() {
    slab_ = 0;
    filled_ = 0;
    used_ = 0;
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
        levels_.push_back(
            {std::uint32_t(bins_per_group_), std::uint32_t(columns), float(columns - 1), float(rows - 1)});
        bins_per_group_ += columns * rows;
        if (columns == 1 && rows == 1) break;
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
    }
    // The last block of each bin and worker is half empty on average: an eighth of the memory at most.
    const std::int64_t writers_bins = std::max<std::int64_t>(1, bins() * thread_count());
    block_records_ = std::clamp<std::int64_t>(expected_records / (4 * writers_bins), least_block, 128);
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
    const Ellipse e = ellipse_of(shape);
    sum.least_px = std::min(sum.least_px, nodes.least_px);
    sum.largest_px = std::max(sum.largest_px, nodes.largest_px);
    if (!counts_here(grid_, y_px)) return;
    ++sum.instances;
    sum.footprint_px += real::pi * float(e.larger) * float(e.smaller);
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
    find_bins({float(grid_.x0), float(grid_.y0), float(grid_.tile_px), levels_}, writer.discs, count,
              writer.rects.data());
    const auto group_bin = std::uint32_t(group * bins_per_group_);
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
    // The store is shared; a limit is not to be spent on unused blocks.
    const std::int64_t share =
        store.limit_bytes() / (8 * thread_count() * block_records_ * std::int64_t{sizeof(ScreenSplat)});
    const std::int64_t blocks_at_once = store.limit_bytes() > 0 ? std::clamp<std::int64_t>(share, 1, 64) : 64;
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

/// Sets shapes_: each writer's, which are given back, after those of the writers before, with their numbers
/// in its records.
void TileBins::join_shapes(std::span<Writer> writers) {
    std::size_t all = 0;
    for (const Writer& writer : writers) all += writer.shapes.size();
    shapes_.clear();
    shapes_.reserve(all);
    for (Writer& writer : writers) {
        const auto first = std::uint32_t(shapes_.size());
        shapes_.insert(shapes_.end(), writer.shapes.begin(), writer.shapes.end());
        if (first > 0 && !writer.shapes.empty())
            for (const Block& block : writer.blocks)
                for (ScreenSplat& splat : records_of(writer, block))
                    if (!is_round(splat)) set_shape_number(splat, shape_number(splat) + first);
        writer.shapes = {};
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
    first_block_.assign(std::size_t(bins()) + 1, 0);
    for (const Writer& writer : writers)
        for (const Block& block : writer.blocks) ++first_block_[block.bin + 1];
    for (std::size_t b = 1; b < first_block_.size(); ++b) first_block_[b] += first_block_[b - 1];
    blocks_.resize(first_block_.back());
    std::vector<std::size_t> next = first_block_;
    for (const Writer& writer : writers)
        for (const Block& block : writer.blocks) blocks_[next[block.bin]++] = records_of(writer, block);
}

/// The work in pieces; also makes room for the ids of blocks.
std::vector<TileBins::Chunk> TileBins::chunks_of(std::span<const LayerProjection> layers,
                                                 const DepthRange& slab,
                                                 std::span<const VisibleBlock> blocks) {
    std::vector<Chunk> chunks;
    for (std::size_t l = 0; l < layers.size(); ++l)
        for (std::int64_t begin = 0; !layers[l].blocks && begin < layers[l].splats->size();
             begin += chunk_splats)
            chunks.push_back({l, begin, std::min(begin + chunk_splats, layers[l].splats->size())});
    tie_ids_.of_layer.clear();
    if (!blocks.empty()) tie_ids_.of_layer.resize(layers.size());
    for (const VisibleBlock& block : blocks) {
        if (!block.depths.meets(slab)) continue;
        const auto number = std::int64_t(block.block);
        std::vector<const std::uint64_t*>& ids = tie_ids_.of_layer[block.layer];
        if (ids.size() >> (32 - TieIds::row_bits)) throw StoreFull();
        chunks.push_back({block.layer, number, number + 1, true, std::uint32_t(ids.size())});
        ids.push_back(nullptr);
    }
    return chunks;
}

void TileBins::scatter_chunk(const LayerProjection& layer, int group, const Chunk& chunk,
                             const DepthRange& slab, Sums& sums, SplatStore& store, Writer& writer,
                             const Progress& progress) const {
    const ScreenRect rect = rect_of(grid_);
    const auto put_away = [&](std::size_t first_shape) {
        if (!slab.is_all()) keep_in_slab(slab, first_shape, writer.splats, writer.shapes);
        if (layer.blocks) number_by_ids(*layer.splats, chunk.slot, writer);
        sum_up(writer, sums);
        write(list_entries(layer, group, writer), store, writer);
    };
    for (std::int64_t begin = chunk.begin; begin < chunk.end; begin += step_splats) {
        progress.check();
        writer.splats.clear();
        writer.rest.clear();
        const std::size_t first_shape = writer.shapes.size();
        project_most(layer, begin, std::min(begin + step_splats, chunk.end), rect, writer.splats,
                     writer.shapes, writer.rest);
        put_away(first_shape);
        for (std::size_t i = 0; i < writer.rest.size(); i += step_rest) {
            progress.check();
            writer.splats.clear();
            const std::span<const std::int64_t> rows(writer.rest);
            project_rows(layer, rows.subspan(i, std::min(step_rest, rows.size() - i)), rect, writer.splats);
            put_away(writer.shapes.size());
        }
    }
}

/// The rows that records name become places in the list of ids.
void TileBins::number_by_ids(const ShadedSplats& block, std::uint32_t slot, Writer& writer) {
    for (ScreenSplat& splat : writer.splats) {
        if (writer.ids.empty() || splat.index != writer.last_row) {
            writer.last_row = splat.index;
            writer.ids.push_back(block.id[splat.index]);
        }
        splat.index = slot << TieIds::row_bits | std::uint32_t(writer.ids.size() - 1);
    }
}

void TileBins::scatter_block(const LayerProjection& layer, int group, const Chunk& chunk,
                             const DepthRange& slab, Sums& sums, SplatStore& store, Writer& writer,
                             const Progress& progress) {
    layer.blocks->shade(std::size_t(chunk.begin), writer.block);
    LayerProjection here = layer;
    here.splats = &writer.block;
    writer.ids.clear();
    scatter_chunk(here, group, {chunk.layer, 0, writer.block.size(), true, chunk.slot}, slab, sums, store,
                  writer, progress);
    auto* const ids = store.take<std::uint64_t>(std::ssize(writer.ids));
    std::ranges::copy(writer.ids, ids);
    tie_ids_.of_layer[chunk.layer][chunk.slot] = ids;
}

void TileBins::scatter(std::span<const LayerProjection> layers, std::span<const int> group_of_layer,
                       const DepthRange& slab, std::span<const VisibleBlock> blocks, SplatStore& store,
                       const Progress& progress) {
    const std::vector<Chunk> chunks = chunks_of(layers, slab, blocks);
    sums_.assign(chunks.size(), {});
    std::vector<Writer> writers(thread_count());
    for (Writer& writer : writers) writer.cursors.resize(bins());
    parallel_for(std::int64_t(chunks.size()), [&](std::int64_t c, int worker) {
        const Chunk& chunk = chunks[c];
        const LayerProjection& layer = layers[chunk.layer];
        const int group = group_of_layer[chunk.layer];
        if (chunk.is_block)
            scatter_block(layer, group, chunk, slab, sums_[c], store, writers[worker], progress);
        else
            scatter_chunk(layer, group, chunk, slab, sums_[c], store, writers[worker], progress);
    });
    join_shapes(writers);
    sort_blocks(writers);
}

std::int64_t TileBins::least_bytes(const TileGrid& grid, int groups) {
    const std::int64_t bins = TileBins(grid, groups, 0).bins();
    return 4 * bins * thread_count() * least_block * std::int64_t(sizeof(ScreenSplat));
}

std::int64_t TileBins::records() const {
    std::int64_t records = 0;
    for (const auto& block : blocks_) records += std::ssize(block);
    return records;
}

std::int64_t TileBins::records_of_fullest(int tiles) const {
    std::vector<std::int64_t> records;
    std::vector<std::span<const ScreenSplat>> runs;
    for (std::int64_t tile = 0; tile < grid_.tiles(); ++tile)
        for (int group = 0; group < groups_; ++group) {
            collect(tile, group, runs);
            records.push_back(0);
            for (const auto& run : runs) records.back() += std::ssize(run);
        }
    std::ranges::sort(records, std::greater<>());
    records.resize(std::min<std::size_t>(records.size(), std::size_t(tiles)));
    return std::accumulate(records.begin(), records.end(), std::int64_t{0});
}

void TileBins::collect(std::int64_t tile, int group, std::vector<std::span<const ScreenSplat>>& out) const {
    out.clear();
    const std::int64_t column = tile % grid_.columns(), row = tile / grid_.columns();
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        const BinLevel& level = levels_[l];
        const std::int64_t bin =
            group * bins_per_group_ + level.first_bin + (row >> l) * level.columns + (column >> l);
        const auto at = [&](std::int64_t b) { return blocks_.begin() + std::ptrdiff_t(first_block_[b]); };
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

}  // namespace astrosplat
