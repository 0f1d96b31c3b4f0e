#include "render/frame_job.h"

#include <cstdlib>

#include "camera/projection.h"
#include "core/parallel.h"
#include "core/real.h"
#include "render/shape.h"
#include "render/shared_render.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

RenderCache::State::Profile numbers_of(const Falloff& falloff) {
    return {int(falloff.shape), falloff.core, falloff.sharpness};
}

/// Drops all entries when an animated falloff has filled the map, so that a long sequence stays small.
template <class Map>
void keep_small(Map& map) {
    constexpr std::size_t most = 64;
    if (map.size() > most) map.clear();
}

/// The largest light of a single splat: alpha * opacity * brightest channel, over all layers (DESIGN 7's L).
/// Taken over all splats, seen or not, so that a region renders as the whole does.
float largest_light(std::span<const RenderLayer> layers, const Progress& progress) {
    constexpr std::int64_t chunk = 1 << 18;
    float largest = 0.0f;
    for (const RenderLayer& layer : layers) {
        if (layer.stars) continue;  // largest_star_light
        const LevelOfDetail& lod = layer.render.lod;
        const float structure = lod.max_px > 0.0f ? largest_child_light(lod.noise) : 1.0f,
                    star = stars_stay_points(layer.render) ? brightest_near_star / structure : 1.0f;
        if (layer.blocks) {
            largest = std::max(largest, layer.blocks->largest_light() * layer.render.opacity * structure *
                                            std::max(1.0f, star));
            continue;
        }
        if (layer.on_device) {
            const float most =
                std::max(layer.on_device->largest_light, layer.on_device->largest_star_light * star);
            largest = std::max(largest, most * layer.render.opacity * structure);
            continue;
        }
        const ShadedSplats& splats = *layer.splats;
        std::vector<float> partial(std::size_t((splats.size() + chunk - 1) / chunk), 0.0f);
        parallel_chunks(splats.size(), chunk, [&](std::int64_t begin, std::int64_t end, int) {
            progress.check();
            float most = 0.0f;
            for (std::int64_t i = begin; i < end; ++i) {
                const glm::vec3& c = splats.color[i];
                const float nearest = is_star(splats.id[i]) ? star : 1.0f;
                most = std::max(most, splats.alpha[i] * std::max({c.x, c.y, c.z}) * nearest);
            }
            partial[begin / chunk] = most;
        });
        for (float p : partial) largest = std::max(largest, p * layer.render.opacity * structure);
    }
    return largest;
}

/// Transmittance below which a pixel is closed.
float stop_threshold(float largest, float exposure_stops) {
    const double exposed = largest * real::exp(std::max(0.0f, exposure_stops) * real::log(2.0));
    return float(0x1p-16 / std::max(1.0, exposed));
}

}  // namespace

RenderCache::RenderCache() : state(std::make_unique<State>()) {}
RenderCache::~RenderCache() = default;

FootprintTable& RenderCache::State::footprint(const Falloff& falloff, float pixel_filter) {
    std::unique_ptr<FootprintTable>& table = footprints[{numbers_of(falloff), pixel_filter}];
    if (!table) table = std::make_unique<FootprintTable>(begin_footprint_table(falloff, pixel_filter));
    return *table;
}

const LodTable& RenderCache::State::lod(const Falloff& falloff, int finest, const Progress& progress) {
    std::unique_ptr<LodTable>& table = lods[numbers_of(falloff)];
    if (!table) table = std::make_unique<LodTable>(falloff);
    table->prepare(finest, progress);
    return *table;
}

void prepare(FrameJob& job, RenderCache::State& cache) {
    const RenderSettings& settings = job.settings;
    const std::span<const RenderLayer> layers = job.layers;
    const Camera& camera = job.camera;
    job.region = settings.region;
    if (job.region.width <= 0 || job.region.height <= 0) job.region = {0, 0, settings.width, settings.height};
    job.fold.aovs = settings.aov_depth || settings.aov_coverage || settings.aov_count || settings.aov_layers;
    job.groups = make_groups(layers, job.fold.aovs);
    job.group_of_layer.resize(layers.size());
    for (std::size_t g = 0; g < job.groups.size(); ++g)
        for (std::size_t l : job.groups[g].layers) job.group_of_layer[l] = int(g);
    keep_small(cache.footprints);
    keep_small(cache.lods);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const LayerRender& render = layers[l].render;
        const FootprintTable& footprints = cache.footprint(render.falloff, settings.pixel_filter);
        LayerProjection projection = make_projection(layers[l], std::uint16_t(l), camera, settings);
        projection.reach = footprints.reach;
        projection.variance = footprints.variance;
        projection.cancelled = job.progress.cancelled;
        if (projection.lod_limit_px > 0.0f)
            projection.lod = &cache.lod(render.falloff, finest_level(render.lod.max_children), job.progress);
        if (layers[l].stars) projection.star_splats = star_splats(*layers[l].stars, footprints);
        job.projections.push_back(projection);
        job.fold_layers.push_back(
            {&footprints, render.blend, render.holdout, render.absorb, layers[l].absorbs});
    }
    float largest = largest_light(layers, job.progress);
    for (const LayerProjection& projection : job.projections)
        if (!projection.star_splats.empty()) largest = std::max(largest, largest_star_light(projection));
    if (job.environment) largest = std::max(largest, job.environment->largest);
    job.fold.stop = stop_threshold(largest, settings.exposure);
    job.fold.lens = make_lens(camera);
}

void make_footprints(const FrameJob& job, const TileBins::Sums& sums, RenderCache::State& cache) {
    if (sums.least_px > sums.largest_px) return;
    const float largest_px = shared::is_onto_sphere(job.fold.lens)
                                 ? std::max(sums.largest_px, sphere_spectrum_px * 1.05f)
                                 : sums.largest_px;
    for (const RenderLayer& layer : job.layers)
        make_footprint_nodes(cache.footprint(layer.render.falloff, job.settings.pixel_filter), sums.least_px,
                             largest_px, job.progress);
}

namespace {

bool has_blocks(const FrameJob& job) {
    return std::ranges::any_of(job.layers, [](const RenderLayer& layer) { return layer.blocks != nullptr; });
}

/// Tile rows of each band so that it takes no more than the limit: its records, or the pixels between slabs.
std::int64_t rows_per_band(const FrameJob& job, const Tiles& tiles) {
    const std::int64_t limit = job.settings.memory_limit_bytes, rows = tiles.grid.rows();
    const std::int64_t records = tiles.records * std::int64_t(sizeof(ScreenSplat));
    if (limit <= 0 || records <= limit) return rows;
    const std::int64_t bytes = has_blocks(job) ? 4 * carried_bytes(job, tiles.grid) : records;
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
    for (const RenderLayer& layer : job.layers) splats += double(layer.size());
    const auto records = double(tiles.records);
    const double bands = std::min(records / records_of_part, most_share * record_of_look * records / splats);
    return std::min(most, int(bands / 2.0));
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
                const double each = double(blocks[b].splats) / double(std::max<std::int64_t>(1, end - begin));
                for (std::int64_t i = begin; i < end; i += block)
                    sample(here, i, std::min(i + block, end), each);
            }
            continue;
        }
        const std::int64_t count = layer.splats->size(), rest = count % stride;
        const std::int64_t sampled = count / stride * block + std::min(rest, block);
        const double each = double(count) / double(std::max<std::int64_t>(1, sampled));
        for (std::int64_t begin = 0; begin < count; begin += stride)
            sample(layer, begin, std::min(begin + block, count), each);
    }
}

/// Records that a splat leaves in tiles of a size, about.
float records_of(const LayerProjection& layer, const ScreenSplat& splat, const Buffer<Shape>& shapes,
                 int tile_px) {
    const float tiles = 1.0f + 2.0f * support_px(layer, splat, shapes) / float(tile_px);
    return std::min(9.0f, tiles * tiles);
}

/// Records that the layers will take in tiles of each of the sizes, estimated from every 64th block
/// of splats, and from the sample of those that come by the block.
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
    for (const double sum : sums) records.push_back(std::int64_t(sum));
    return records;
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
    const bool in_cache =
        double(records[1]) * job.settings.splats_each <= double(records_in_cache * grid.tiles());
    const bool saves = double(records[0]) >= worth_missing_it * double(records[1]);
    if (enough_to_share && (in_cache || saves)) return {grid, records[1]};
    grid.tile_px = small_px;
    return {grid, records[0]};
}

std::int64_t carried_bytes(const FrameJob& job, const TileGrid& grid) {
    const std::int64_t planes = 9 + (job.fold.aovs ? 3 + 4 * std::int64_t(job.layers.size()) : 0);
    const std::int64_t pixels = grid.tiles() * grid.tile_px * grid.tile_px;
    return pixels * planes * std::int64_t(sizeof(float) * job.groups.size());
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

double DepthSample::records() const {
    double all = 0.0;
    for (const DepthShare& share : shares) all += share.records;
    return all;
}

std::vector<DepthRange> DepthSample::cut(double most_records, std::uint32_t first) const {
    std::vector<DepthRange> ranges = {{first, 0xffffffffu}};
    double records = 0.0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (shares[i].depth < first) continue;
        records += shares[i].records;
        const bool may_cut = i > 0 && shares[i].depth > std::max(shares[i - 1].depth, ranges.back().first);
        if (!may_cut || records <= most_records) continue;
        ranges.back().last = shares[i].depth - 1;
        ranges.push_back({shares[i].depth, 0xffffffffu});
        records = shares[i].records;
    }
    return ranges;
}

std::pair<DepthRange, DepthRange> DepthSample::halve(const DepthRange& range) const {
    double all = 0.0, near = 0.0;
    for (const DepthShare& share : shares) all += range.holds(share.depth) ? share.records : 0.0;
    std::uint32_t last = range.first + (range.last - range.first) / 2;
    for (const DepthShare& share : shares) {
        if (!range.holds(share.depth)) continue;
        near += share.records;
        if (2.0 * near < all) continue;
        // Beyond the sample's ends there may be many; no range is to be tried twice.
        if (share.depth > range.first && share.depth < range.last) last = share.depth;
        break;
    }
    return {{range.first, last}, {last + 1, range.last}};
}

}  // namespace astrosplat
