#include "render/plan_bands.h"

#include <algorithm>
#include <cstdlib>

#include "core/parallel.h"
#include "render/record_sample.h"
#include "render/tiles.h"

namespace astrosplat {
namespace {

bool has_blocks(const FrameJob& job) {
    return std::ranges::any_of(job.layers, [](const RenderLayer& layer) { return layer.blocks != nullptr; });
}

/// Tile rows of each band so that it takes no more than the limit: its records, or the pixels between slabs.
std::int64_t rows_per_band(const FrameJob& job, const Tiles& tiles) {
    const std::int64_t limit = job.settings.memory_limit_bytes, rows = tiles.grid.rows();
    const std::int64_t records = tiles.records * static_cast<std::int64_t>(sizeof(ScreenSplat));
    if (limit <= 0 || records <= limit) return rows;
    const std::int64_t bytes = has_blocks(job) ? 4 * CarriedTiles::bytes(job, tiles.grid) : records;
    const std::int64_t bands = std::max<std::int64_t>(1, (bytes + limit - 1) / limit);
    return std::max<std::int64_t>(1, rows / std::min(rows, bands));
}

/// The same heights for all, but for what is left over at the end.
std::vector<std::int64_t> limited_rows(const FrameJob& job, const Tiles& tiles) {
    const std::int64_t each = rows_per_band(job, tiles);
    std::vector<std::int64_t> rows;
    for (std::int64_t left = tiles.grid.rows(); left > 0; left -= rows.back())
        rows.push_back(std::min(each, left));
    return rows;
}

/// Bands above a middle one, and as many below it; 0: one band is all. Each costs another look at all splats,
/// and together they may take a part of the time of the records.
int watched_parts(const FrameJob& job, const Tiles& tiles) {
    constexpr double record_of_look = 16.0;  // a record is worth so many looks
    constexpr double most_share = 0.15, records_of_part = 1e6;
    constexpr int most = 2;
    double splats = 1.0;
    for (const RenderLayer& layer : job.layers) splats += static_cast<double>(layer.size());
    const auto records = static_cast<double>(tiles.records);
    const double bands = std::min(records / records_of_part, most_share * record_of_look * records / splats);
    return std::min(most, static_cast<int>(bands / 2.0));
}

void add_parts(std::int64_t rows, int parts, std::vector<std::int64_t>& heights) {
    for (std::int64_t i = 0; i < parts; ++i) {
        const std::int64_t part = rows * (i + 1) / parts - rows * i / parts;
        if (part > 0) heights.push_back(part);
    }
}

/// For who watches the frame: a narrow band in the middle, whose tiles are there soon, between higher ones,
/// which then use its memory again.
std::vector<std::int64_t> watched_rows(const FrameJob& job, const Tiles& tiles) {
    const std::int64_t rows = tiles.grid.rows(), columns = tiles.grid.columns();
    const std::int64_t to_share = (4 * thread_count() + columns - 1) / columns;
    const std::int64_t middle = std::max(rows / 12, to_share);
    const int parts = has_blocks(job) ? 0 : watched_parts(job, tiles);
    if (parts == 0 || 3 * middle > rows) return {rows};
    std::vector<std::int64_t> heights;
    const std::int64_t above = (rows - middle) / 2;
    add_parts(above, parts, heights);
    heights.push_back(middle);
    add_parts(rows - middle - above, parts, heights);
    return heights;
}

}  // namespace

/// Large tiles cut fewer splats into several records; small ones keep a tile's records in a core's cache.
Tiles choose_tiles(const FrameJob& job) {
    constexpr int small_px = 32, large_px = 64;
    constexpr std::int64_t records_in_cache = 16384;  // measured: up to here the larger tiles are quicker,
    constexpr double worth_missing_it = 1.5;          // and beyond if they save so many records
    TileGrid grid{job.region.x, job.region.y, job.region.width, job.region.height, large_px};
    if (job.settings.tile_px > 0) {
        grid.tile_px = job.settings.tile_px;
        return {grid, estimate_records(job.projections, grid, {&grid.tile_px, 1}, job.progress)[0]};
    }
    const int sizes[] = {small_px, large_px};
    const std::vector<std::int64_t> records = estimate_records(job.projections, grid, sizes, job.progress);
    const bool enough_to_share = grid.tiles() >= 8 * thread_count();
    const bool in_cache = static_cast<double>(records[1]) * job.settings.splats_each <=
                          static_cast<double>(records_in_cache * grid.tiles());
    const bool saves = static_cast<double>(records[0]) >= worth_missing_it * static_cast<double>(records[1]);
    if (enough_to_share && (in_cache || saves)) return {grid, records[1]};
    grid.tile_px = small_px;
    return {grid, records[0]};
}

Bands make_bands(const FrameJob& job) {
    const Tiles tiles = choose_tiles(job);
    const TileGrid& grid = tiles.grid;
    std::vector<std::int64_t> heights = limited_rows(job, tiles);
    if (job.tile_done && heights.size() == 1) heights = watched_rows(job, tiles);
    Bands bands;
    std::int64_t row = 0, highest = 0;
    for (const std::int64_t rows : heights) {
        TileGrid band = grid;
        band.y0 = grid.y0 + row * grid.tile_px;
        band.height = std::min(rows * grid.tile_px, grid.y0 + grid.height - band.y0);
        band.first_band = row == 0;
        row += rows;
        band.last_band = row == grid.rows();
        bands.grids.push_back(band);
        highest = std::max(highest, rows);
    }
    bands.records = tiles.records * highest / grid.rows();
    if (!job.tile_done) return bands;
    const auto from_middle = [&](const TileGrid& band) {
        return std::abs(2 * (band.y0 - grid.y0) + band.height - grid.height);
    };
    std::ranges::stable_sort(
        bands.grids, [&](const TileGrid& a, const TileGrid& b) { return from_middle(a) < from_middle(b); });
    return bands;
}

}  // namespace astrosplat
