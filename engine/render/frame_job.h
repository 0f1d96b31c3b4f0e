// State that every band, slab and tile of a frame being rendered shares, and how the frame is cut: the size
// of its tiles, bands of rows of them, and samples of the frame's splats, by which that is decided before
// they are projected. In: render()'s arguments. Out: projections, blend groups, tables and fold settings;
// grids of tiles, in the order in which they are rendered, and the depths of records.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "core/progress.h"
#include "render/depth_slabs.h"
#include "render/fold.h"
#include "render/footprint.h"
#include "render/lod.h"
#include "render/project.h"
#include "render/render.h"
#include "render/resolve.h"
#include "render/scatter.h"

namespace astrosplat {

struct RenderCache::State {
    using Profile = std::tuple<int, float, float>;  // shape, core, sharpness
    using Table = std::tuple<Profile, float>;       // and pixel filter
    SplatStore store;
    std::map<Table, std::unique_ptr<FootprintTable>> footprints;
    std::map<Profile, std::unique_ptr<LodTable>> lods;

    FootprintTable& footprint(const Falloff& falloff, float pixel_filter);
    const LodTable& lod(const Falloff& falloff, int finest, const Progress& progress);
};

/// One frame being rendered: what every band and tile shares.
struct FrameJob {
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

/// The parts of a job that follow from its arguments.
void prepare(FrameJob& job, RenderCache::State& cache);

/// Makes the footprints that the splats of a band ask for.
void make_footprints(const FrameJob& job, const TileBins::Sums& sums, RenderCache::State& cache);

// ---- how a frame is cut, which changes no pixel

/// The frame's tiles, and the records they will take, roughly.
struct Tiles {
    TileGrid grid;
    std::int64_t records = 0;
};
Tiles choose_tiles(const FrameJob& job);

/// Bytes of the state of the fold of all tiles of a grid, where it stays between slabs of depth and splats
/// are everywhere.
std::int64_t carried_bytes(const FrameJob& job, const TileGrid& grid);

/// The frame in bands, each of some rows of tiles, so that what they take keeps to the memory limit as far as
/// can be told before. With tile_done those nearest to the middle come first, and what has many splats is cut
/// so that its first tiles come soon.
struct Bands {
    std::vector<TileGrid> grids;
    std::int64_t records = 0;  // that the largest will take, roughly
};
Bands make_bands(const FrameJob& job);

/// Records that the layers will take in tiles of each of the sizes, estimated from every 64th block
/// of splats, and from the sample of those that come by the block.
std::vector<std::int64_t> estimate_records(std::span<const LayerProjection> layers, const TileGrid& grid,
                                           std::span<const int> tile_sizes_px, const Progress& progress);

/// The same by depth.
DepthSample sample_depths(std::span<const LayerProjection> layers, const TileGrid& grid,
                          const Progress& progress);

}  // namespace astrosplat
