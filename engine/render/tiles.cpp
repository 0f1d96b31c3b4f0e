#include "render/frame_job.h"

#include <new>
#include <numeric>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "render/device.h"

namespace astrosplat {
namespace {

Region tile_region(const TileGrid& grid, std::int64_t tile) {
    const std::int64_t x = grid.x0 + tile % grid.columns() * grid.tile_px;
    const std::int64_t y = grid.y0 + tile / grid.columns() * grid.tile_px;
    return {x, y, std::min<std::int64_t>(grid.tile_px, grid.x0 + grid.width - x),
            std::min<std::int64_t>(grid.tile_px, grid.y0 + grid.height - y)};
}

FoldSettings fold_settings(const FrameJob& job, std::size_t group) {
    FoldSettings settings = job.fold;
    if (group < job.groups.size()) settings.kind = job.groups[group].kind;
    return settings;
}

void reset(const FrameJob& job, const Region& region, std::size_t group, TilePlanes& planes) {
    planes.reset(region, fold_settings(job, group), job.layers.size());
}

/// Folds the records that the worker has collected.
void fold_runs(const FrameJob& job, const TileBins& bins, std::size_t group, TileWorker& worker,
               TilePlanes& planes) {
    const std::span<const ScreenSplat* const> order =
        worker.sorter.sort(worker.runs, job.progress, bins.tie_ids());
    fold({order, job.fold_layers, fold_settings(job, group), job.progress, bins.shapes()}, planes);
}

/// Whether a tile's only group goes straight into the frame.
bool stands_alone(const FrameJob& job) {
    const bool nothing_behind = !job.environment || job.settings.backdrop;
    return job.groups.size() == 1 && !job.groups[0].isolated && !job.fold.aovs && nothing_behind;
}

/// Composites the groups, far to near, and writes the tile. folded(group): its planes, or null where no splat
/// reached them.
template <class Folded>
void resolve_tile(const FrameJob& job, const Region& region, TileWorker& worker, RenderedFrame& frame,
                  const Folded& folded) {
    const bool alone = stands_alone(job), behind = job.environment || job.settings.backdrop;
    const TilePlanes* tile = nullptr;  // of any group; until then the tile is as black as the new frame
    for (std::size_t g = 0; g < std::max<std::size_t>(1, job.groups.size()); ++g) {
        const TilePlanes* planes = g < job.groups.size() ? folded(g) : nullptr;
        if (!planes && !behind) continue;
        if (!planes) {
            reset(job, region, g, worker.planes);
            planes = &worker.planes;
        }
        if (!tile && !alone) worker.resolver.begin(*planes, job.camera, job.environment);
        tile = planes;
        if (g == job.groups.size()) break;  // nothing but the environment
        if (!alone) worker.resolver.composite(job.groups[g], *planes);
    }
    if (tile && alone)
        worker.resolver.write_alone(job.groups[0], *tile, job.region.x, job.region.y, frame);
    else if (tile)
        worker.resolver.write(*tile, job.region.x, job.region.y, frame);
    if (job.tile_done) job.tile_done(region, frame);
}

}  // namespace

std::vector<TileWorker> make_tile_workers(const FrameJob& job) {
    std::vector<TileWorker> workers;
    for (int i = 0; i < thread_count(); ++i)
        workers.push_back({{}, {}, {}, TileResolver(job.layers, job.settings)});
    return workers;
}

std::vector<std::int64_t> tile_order(const FrameJob& job, const TileGrid& grid) {
    std::vector<std::int64_t> order(std::size_t(grid.tiles()));
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

void render_tile(const FrameJob& job, const TileBins& bins, std::int64_t tile, TileWorker& worker,
                 RenderedFrame& frame) {
    const Region region = tile_region(bins.grid(), tile);
    resolve_tile(job, region, worker, frame, [&](std::size_t g) -> const TilePlanes* {
        bins.collect(tile, int(g), worker.runs);
        if (worker.runs.empty()) return nullptr;
        reset(job, region, g, worker.planes);
        fold_runs(job, bins, g, worker, worker.planes);
        return &worker.planes;
    });
}

namespace {

/// A group's planes over a tile's region, out of those over the whole.
void copy_planes(const FrameJob& job, const GroupPlanes& group, TilePlanes& planes) {
    const auto copy = [&](const Image& from, std::initializer_list<Buffer<float>*> to) {
        if (from.pixels.empty()) return;  // as reset
        for (int y = 0; y < planes.height; ++y) {
            const float* row = from.at(planes.x0 - job.region.x, planes.y0 - job.region.y + y);
            for (int x = 0; x < planes.width; ++x)
                for (std::size_t k = 0; Buffer<float> * plane : to)
                    (*plane)[planes.at(x, y)] = row[4 * x + int(k++)];
        }
    };
    auto& t = planes.transmittance;
    copy(group.light, {&planes.color[0], &planes.color[1], &planes.color[2], &planes.alpha});
    copy(group.through, {&t[0], &t[1], &t[2], &t[3]});
    if (job.fold.aovs)
        copy(group.more, {&planes.held, &planes.depth_sum, &planes.uncovered, &planes.count});
    else
        copy(group.more, {&planes.held});
    for (std::size_t l = 0; l < group.layer_light.size(); ++l) {
        Buffer<float>* light = &planes.layer_light[4 * l];
        copy(group.layer_light[l], {light, light + 1, light + 2, light + 3});
    }
}

/// None where the device has drawn less than all. Throws NotEnoughMemory, std::bad_alloc.
std::optional<DrawnGroups> draw_groups(const FrameJob& job, RenderStatistics& statistics) {
    DrawnGroups drawn{{}, stands_alone(job) && !job.settings.backdrop};
    if (!drawn.alone)  // the frame itself is claimed with its images
        claim_memory(job.region.width * job.region.height * 3 * 16 * std::ssize(job.groups),
                     "what a card draws");
    for (std::size_t g = 0; g < job.groups.size(); ++g) {
        std::optional<GroupPlanes> planes = job.settings.device->draw(job, g, drawn.alone);
        job.progress.at(0.9 * double(g + 1) / double(job.groups.size()));
        if (!planes) return {};
        statistics.splats_drawn += planes->splats;
        statistics.mean_overlap += planes->footprint_px;
        drawn.planes.push_back(std::move(*planes));
    }
    statistics.device = job.settings.device->name();
    return drawn;
}

}  // namespace

std::optional<DrawnGroups> draw_on_device(const FrameJob& job, RenderCache::State& cache,
                                          RenderStatistics& statistics) {
    statistics.not_on_device = job.settings.device->cannot(job);
    if (!statistics.not_on_device.empty()) return {};
    make_footprints(job, {0, 0.0, 0.0f, std::numeric_limits<float>::max()}, cache);
    try {
        if (std::optional<DrawnGroups> drawn = draw_groups(job, statistics)) return drawn;
    } catch (const NotEnoughMemory&) {  // the processor does with less, in bands
    } catch (const std::bad_alloc&) {
    }
    statistics = {};
    statistics.not_on_device = "it ran out of memory or was lost";
    return {};
}

void resolve_drawn(const FrameJob& job, DrawnGroups drawn, RenderedFrame& frame) {
    if (drawn.alone) {
        frame.beauty = std::move(drawn.planes[0].light);
        if (job.tile_done) job.tile_done(job.region, frame);
        return;
    }
    const TileGrid grid{job.region.x, job.region.y, job.region.width, job.region.height, 64};
    const std::vector<std::int64_t> order = tile_order(job, grid);
    std::vector<TileWorker> workers = make_tile_workers(job);
    parallel_for(grid.tiles(), [&](std::int64_t i, int worker) {
        job.progress.check();
        TileWorker& own = workers[worker];
        const Region region = tile_region(grid, order[i]);
        resolve_tile(job, region, own, frame, [&](std::size_t g) -> const TilePlanes* {
            reset(job, region, g, own.planes);
            copy_planes(job, drawn.planes[g], own.planes);
            return &own.planes;
        });
    });
}

void CarriedTiles::fold_slab(const TileBins& bins, std::int64_t tile, TileWorker& worker) {
    for (std::size_t g = 0; g < job_.groups.size(); ++g) {
        bins.collect(tile, int(g), worker.runs);
        if (worker.runs.empty()) continue;
        TilePlanes& planes = planes_of(tile, g);
        if (planes.width == 0) reset(job_, tile_region(grid_, tile), g, planes);
        fold_runs(job_, bins, g, worker, planes);
        for (Buffer<float>& toward : planes.toward) toward = {};  // made anew, and no state
    }
}

void CarriedTiles::finish(std::int64_t tile, TileWorker& worker, RenderedFrame& frame) {
    resolve_tile(job_, tile_region(grid_, tile), worker, frame, [&](std::size_t g) -> const TilePlanes* {
        TilePlanes& planes = planes_of(tile, g);
        return planes.width == 0 ? nullptr : &planes;
    });
    for (std::size_t g = 0; g < job_.groups.size(); ++g) planes_of(tile, g) = {};
}

}  // namespace astrosplat
