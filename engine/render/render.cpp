#include "render/render.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <tuple>

#include "camera/projection.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "render/child_noise.h"
#include "render/fold.h"
#include "render/lod.h"
#include "render/project.h"
#include "render/project_stars.h"
#include "render/resolve.h"
#include "render/scatter.h"
#include "render/spectrum.h"
#include "render/splat_sorter.h"

namespace astrosplat {
namespace {

using FalloffNumbers = std::tuple<int, float, float>;    // shape, core, sharpness
using TableNumbers = std::tuple<FalloffNumbers, float>;  // and pixel filter

FalloffNumbers numbers_of(const Falloff& falloff) {
    return {static_cast<int>(falloff.shape), falloff.core, falloff.sharpness};
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
        const ShadedSplats& splats = *layer.splats;
        std::vector<float> partial(static_cast<std::size_t>((splats.size() + chunk - 1) / chunk), 0.0f);
        parallel_chunks(splats.size(), chunk, [&](std::int64_t begin, std::int64_t end, int) {
            progress.check();
            float most = 0.0f;
            for (std::int64_t i = begin; i < end; ++i) {
                const glm::vec3& c = splats.color[i];
                most = std::max(most, splats.alpha[i] * std::max({c.x, c.y, c.z}));
            }
            partial[begin / chunk] = most;
        });
        const LevelOfDetail& lod = layer.render.lod;
        const float structure = lod.max_px > 0.0f ? largest_child_light(lod.noise) : 1.0f;
        for (float p : partial) largest = std::max(largest, p * layer.render.opacity * structure);
    }
    return largest;
}

/// Transmittance below which a pixel is closed.
float stop_threshold(float largest, float exposure_stops) {
    const double exposed = largest * real::exp(std::max(0.0f, exposure_stops) * real::log(2.0));
    return static_cast<float>(0x1p-16 / std::max(1.0, exposed));
}

RenderedFrame make_frame(std::span<const RenderLayer> layers, const RenderSettings& settings,
                         const Region& region) {
    const std::int64_t channels = 4 + settings.aov_depth + settings.aov_coverage + settings.aov_count +
                                  (settings.aov_layers ? 4 * static_cast<std::int64_t>(layers.size()) : 0);
    claim_memory(region.width * region.height * channels * static_cast<std::int64_t>(sizeof(float)),
                 "the frame");
    RenderedFrame frame;
    frame.beauty = make_image(region.width, region.height, 4);
    if (settings.aov_depth) frame.depth = make_image(region.width, region.height, 1);
    if (settings.aov_coverage) frame.coverage = make_image(region.width, region.height, 1);
    if (settings.aov_count) frame.count = make_image(region.width, region.height, 1);
    if (settings.aov_layers)
        for (std::size_t i = 0; i < layers.size(); ++i)
            frame.layers.push_back(make_image(region.width, region.height, 4));
    for (const RenderLayer& layer : layers) frame.statistics.splats_in += layer.splats->size();
    return frame;
}

/// Tile rows of each band so that its records stay within the memory limit.
std::int64_t rows_per_band(std::int64_t records, std::int64_t limit_bytes, std::int64_t rows) {
    const std::int64_t bytes = records * static_cast<std::int64_t>(sizeof(ScreenSplat));
    if (limit_bytes <= 0 || bytes <= limit_bytes) return rows;
    const std::int64_t bands = (bytes + limit_bytes - 1) / limit_bytes;
    return std::max<std::int64_t>(1, rows / std::min(rows, bands));
}

std::int64_t covered_pixels(const Image& beauty) {
    constexpr std::int64_t chunk = 1 << 16;
    std::atomic<std::int64_t> covered = 0;
    parallel_chunks(beauty.width * beauty.height, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::int64_t here = 0;
        const float* p = beauty.pixels.data() + 4 * begin;
        for (std::int64_t i = begin; i < end; ++i, p += 4)
            here += std::max(std::max(p[0], p[1]), std::max(p[2], p[3])) > 0.0f;
        covered += here;
    });
    return covered;
}

}  // namespace

struct RenderCache::State {
    SplatStore store;
    std::map<TableNumbers, std::unique_ptr<FootprintTable>> footprints;
    std::map<FalloffNumbers, std::unique_ptr<LodTable>> lods;

    FootprintTable& footprint(const Falloff& falloff, float pixel_filter) {
        std::unique_ptr<FootprintTable>& table = footprints[{numbers_of(falloff), pixel_filter}];
        if (!table) table = std::make_unique<FootprintTable>(begin_footprint_table(falloff, pixel_filter));
        return *table;
    }
    const LodTable& lod(const Falloff& falloff, int finest, const Progress& progress) {
        std::unique_ptr<LodTable>& table = lods[numbers_of(falloff)];
        if (!table) table = std::make_unique<LodTable>(falloff);
        table->prepare(finest, progress);
        return *table;
    }
};

RenderCache::RenderCache() : state(std::make_unique<State>()) {}
RenderCache::~RenderCache() = default;

namespace {

/// One frame being rendered: what every band and tile shares.
struct Job {
    std::span<const RenderLayer> layers;
    const Camera& camera;
    const Environment* environment;
    const RenderSettings& settings;
    const Progress& progress;
    const TileDone& tile_done;
    Region region;
    std::vector<BlendGroup> groups;
    std::vector<int> group_of_layer;
    std::vector<LayerProjection> projections;
    std::vector<FoldLayer> fold_layers;
    FoldSettings fold;
};

/// What remains to be said of a job after its arguments.
void prepare(Job& job, RenderCache::State& cache) {
    const RenderSettings& settings = job.settings;
    const std::span<const RenderLayer> layers = job.layers;
    const Camera& camera = job.camera;
    job.region = settings.region;
    if (job.region.width <= 0 || job.region.height <= 0) job.region = {0, 0, settings.width, settings.height};
    job.fold.aovs = settings.aov_depth || settings.aov_coverage || settings.aov_count || settings.aov_layers;
    job.groups = make_groups(layers, job.fold.aovs);
    job.group_of_layer.resize(layers.size());
    for (std::size_t g = 0; g < job.groups.size(); ++g)
        for (std::size_t l : job.groups[g].layers) job.group_of_layer[l] = static_cast<int>(g);
    keep_small(cache.footprints);
    keep_small(cache.lods);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const LayerRender& render = layers[l].render;
        const FootprintTable& footprints = cache.footprint(render.falloff, settings.pixel_filter);
        LayerProjection projection =
            make_projection(layers[l], static_cast<std::uint16_t>(l), camera, settings);
        projection.reach = footprints.reach;
        projection.variance = footprints.variance;
        if (projection.lod_limit_px > 0.0f)
            projection.lod = &cache.lod(render.falloff, finest_level(render.lod.max_children), job.progress);
        if (layers[l].stars) projection.star_dots = star_dots(*layers[l].stars, footprints);
        job.projections.push_back(projection);
        job.fold_layers.push_back(
            {&footprints, render.blend, render.holdout, render.absorb, layers[l].absorbs});
    }
    float largest = largest_light(layers, job.progress);
    for (const LayerProjection& projection : job.projections)
        if (!projection.star_dots.empty()) largest = std::max(largest, largest_star_light(projection));
    if (job.environment) largest = std::max(largest, job.environment->largest);
    job.fold.stop = stop_threshold(largest, settings.exposure);
    job.fold.lens = make_lens(camera);
}

/// Scratch of one worker.
struct TileWorker {
    std::vector<std::span<const ScreenSplat>> runs;  // of the tile's records
    SplatSorter sorter;
    TilePlanes planes;
    TileResolver resolver;
};

Region tile_region(const TileGrid& grid, std::int64_t tile) {
    const std::int64_t x = grid.x0 + tile % grid.columns() * grid.tile_px;
    const std::int64_t y = grid.y0 + tile / grid.columns() * grid.tile_px;
    return {x, y, std::min<std::int64_t>(grid.tile_px, grid.x0 + grid.width - x),
            std::min<std::int64_t>(grid.tile_px, grid.y0 + grid.height - y)};
}

/// Whether a tile's only group goes straight into the frame.
bool stands_alone(const Job& job) {
    const bool nothing_behind = !job.environment || job.settings.backdrop;
    return job.groups.size() == 1 && !job.groups[0].isolated && !job.fold.aovs && nothing_behind;
}

void render_tile(const Job& job, const TileBins& bins, std::int64_t tile, TileWorker& worker,
                 RenderedFrame& frame) {
    const Region region = tile_region(bins.grid(), tile);
    const bool alone = stands_alone(job), behind = job.environment || job.settings.backdrop;
    bool begun = false;  // until then the tile is as black as the new frame
    for (std::size_t g = 0; g < std::max<std::size_t>(1, job.groups.size()); ++g) {
        worker.runs.clear();
        if (g < job.groups.size()) bins.collect(tile, static_cast<int>(g), worker.runs);
        if (worker.runs.empty() && !behind) continue;
        FoldSettings fold_settings = job.fold;
        if (g < job.groups.size()) fold_settings.kind = job.groups[g].kind;
        worker.planes.reset(region, fold_settings, job.layers.size());
        if (!begun && !alone) worker.resolver.begin(worker.planes, job.camera, job.environment);
        begun = true;
        if (g == job.groups.size()) break;  // nothing but the environment
        const std::span<const ScreenSplat* const> order = worker.sorter.sort(worker.runs, job.progress);
        fold({order, job.fold_layers, fold_settings, job.progress, bins.shapes()}, worker.planes);
        if (!alone) worker.resolver.composite(job.groups[g], worker.planes);
    }
    if (begun && alone)
        worker.resolver.write_alone(job.groups[0], worker.planes, job.region.x, job.region.y, frame);
    else if (begun)
        worker.resolver.write(worker.planes, job.region.x, job.region.y, frame);
    if (job.tile_done) job.tile_done(region, frame);
}

/// The tiles in the order in which they are rendered: with tile_done from the middle of the
/// frame outwards.
std::vector<std::int64_t> tile_order(const Job& job, const TileGrid& grid) {
    std::vector<std::int64_t> order(static_cast<std::size_t>(grid.tiles()));
    std::iota(order.begin(), order.end(), std::int64_t{0});
    if (!job.tile_done) return order;
    const auto from_middle = [&](std::int64_t tile) {  // twice the distance between centres, squared
        const Region r = tile_region(grid, tile);
        const std::int64_t x = 2 * (r.x - job.region.x) + r.width - job.region.width;
        const std::int64_t y = 2 * (r.y - job.region.y) + r.height - job.region.height;
        return x * x + y * y;
    };
    std::ranges::stable_sort(order,
                             [&](std::int64_t a, std::int64_t b) { return from_middle(a) < from_middle(b); });
    return order;
}

/// Makes the footprints that the splats of a band ask for.
void make_footprints(const Job& job, const TileBins::Sums& sums, RenderCache::State& cache) {
    if (sums.least_px > sums.largest_px) return;
    const float largest_px = shared::is_onto_sphere(job.fold.lens)
                                 ? std::max(sums.largest_px, sphere_spectrum_px * 1.05f)
                                 : sums.largest_px;
    for (const RenderLayer& layer : job.layers)
        make_footprint_nodes(cache.footprint(layer.render.falloff, job.settings.pixel_filter), sums.least_px,
                             largest_px, job.progress);
}

/// One band, which will take about so many `records`; `before` of the frame's share is done already.
void render_band(const Job& job, const TileGrid& grid, std::int64_t records, double before,
                 RenderCache::State& cache, RenderedFrame& frame) {
    const double share = static_cast<double>(grid.height) / static_cast<double>(job.region.height);
    cache.store.clear();
    TileBins bins(grid, static_cast<int>(job.groups.size()), records);
    bins.scatter(job.projections, job.group_of_layer, cache.store, job.progress);
    const TileBins::Sums sums = bins.sums();
    make_footprints(job, sums, cache);
    job.progress.at(before + 0.4 * share);
    std::vector<TileWorker> workers;
    for (int i = 0; i < thread_count(); ++i)
        workers.push_back({{}, {}, {}, TileResolver(job.layers, job.settings)});
    const std::vector<std::int64_t> order = tile_order(job, grid);
    std::atomic<std::int64_t> done = 0;
    parallel_for(grid.tiles(), [&](std::int64_t i, int worker) {
        job.progress.check();
        render_tile(job, bins, order[i], workers[worker], frame);
        const std::int64_t finished = ++done;
        if (finished % 64 == 0)
            job.progress.at(before + share * (0.4 + 0.6 * static_cast<double>(finished) /
                                                        static_cast<double>(grid.tiles())));
    });
    frame.statistics.splats_drawn += sums.instances;
    frame.statistics.mean_overlap += sums.footprint_px;
}

/// The frame's tiles, and the records they will take, roughly.
struct Tiles {
    TileGrid grid;
    std::int64_t records = 0;
};

/// Large tiles cut fewer splats into several records; small ones keep a tile's records in a core's cache.
Tiles choose_tiles(const Job& job) {
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
    const bool in_cache = records[1] <= records_in_cache * grid.tiles();
    const bool saves = static_cast<double>(records[0]) >= worth_missing_it * static_cast<double>(records[1]);
    if (enough_to_share && (in_cache || saves)) return {grid, records[1]};
    grid.tile_px = small_px;
    return {grid, records[0]};
}

/// The frame in bands of `band_rows` rows of tiles, with tile_done those nearest to the middle first.
std::vector<TileGrid> make_bands(const Job& job, const TileGrid& grid, std::int64_t band_rows) {
    std::vector<TileGrid> bands;
    for (std::int64_t row = 0; row < grid.rows(); row += band_rows) {
        TileGrid band = grid;
        band.y0 = grid.y0 + row * grid.tile_px;
        band.height = std::min(band_rows * grid.tile_px, grid.y0 + grid.height - band.y0);
        band.first_band = row == 0;
        band.last_band = row + band_rows >= grid.rows();
        bands.push_back(band);
    }
    if (!job.tile_done) return bands;
    const auto from_middle = [&](const TileGrid& band) {
        return std::abs(2 * (band.y0 - grid.y0) + band.height - grid.height);
    };
    std::ranges::stable_sort(
        bands, [&](const TileGrid& a, const TileGrid& b) { return from_middle(a) < from_middle(b); });
    return bands;
}

/// A Gaussian that ends at three standard deviations lacks a twentieth of its light, at four a 200th: the
/// same curve further out.
void extend_gaussians(RenderLayer& layer) {
    constexpr float further = 4.0f / 3.0f;
    if (layer.render.falloff.shape != Falloff::Shape::gaussian) return;
    layer.radius_scale *= further;
    layer.render.falloff.sharpness *= further * further;
}

/// Stars as they are drawn: gaussians that add light. Gaussians with their tails.
std::vector<RenderLayer> as_drawn(std::span<const RenderLayer> layers) {
    std::vector<RenderLayer> drawn(layers.begin(), layers.end());
    for (RenderLayer& layer : drawn) {
        if (layer.gaussians) extend_gaussians(layer);
        if (!layer.stars) continue;
        layer.render.falloff = {Falloff::Shape::gaussian, 0.5f, 4.5f};
        layer.render.blend = Blend::add;
        layer.render.lod = {};
        layer.absorbs = false;
    }
    return drawn;
}

}  // namespace

RenderedFrame render(std::span<const RenderLayer> layers, const Camera& camera,
                     const Environment* environment, const RenderSettings& settings, const Progress& progress,
                     RenderCache* cache, const TileDone& tile_done) {
    assert(settings.tile_px == 0 || (settings.tile_px >= 16 && settings.tile_px <= TilePlanes::widest_px &&
                                     settings.tile_px % 8 == 0));
    const auto start = Clock::now();
    for (const RenderLayer& layer : layers)
        if (layer.splats->size() > 0xffffffffLL)
            throw InputError("layer " + layer.name + ": " +
                             human_count(static_cast<double>(layer.splats->size())) +
                             " splats in one layer, at most 4294967295 can be drawn");
    std::unique_ptr<RenderCache> own = cache ? nullptr : std::make_unique<RenderCache>();
    RenderCache::State& state = cache ? *cache->state : *own->state;
    const std::vector<RenderLayer> drawn = as_drawn(layers);
    Job job{drawn, camera, environment, settings, progress, tile_done, {}, {}, {}, {}, {}, {}};
    prepare(job, state);
    const auto [grid, records] = choose_tiles(job);
    const std::int64_t band_rows = rows_per_band(records, settings.memory_limit_bytes, grid.rows());
    const std::int64_t bands = (grid.rows() + band_rows - 1) / band_rows;
    const std::int64_t bytes = records * static_cast<std::int64_t>(sizeof(ScreenSplat)) / bands;
    if (bytes > state.store.bytes()) claim_memory(bytes - state.store.bytes(), "projected splats");
    RenderedFrame frame = make_frame(layers, settings, job.region);
    double done = 0.0;
    for (const TileGrid& band : make_bands(job, grid, band_rows)) {
        render_band(job, band, records / bands, done, state, frame);
        done += static_cast<double>(band.height) / static_cast<double>(grid.height);
    }
    if (settings.memory_limit_bytes > 0) state.store.shrink(settings.memory_limit_bytes);
    const double covered = static_cast<double>(covered_pixels(frame.beauty));
    frame.statistics.mean_overlap = covered > 0.0 ? frame.statistics.mean_overlap / covered : 0.0;
    frame.statistics.seconds = seconds_since(start);
    return frame;
}

}  // namespace astrosplat
