// State that every band, slab and tile of a frame being rendered shares, and how the frame is cut: the size
// of its tiles, bands of rows of them, and samples of the frame's splats, by which that is decided before
// they are projected. In: render()'s arguments. Out: projections, blend groups, tables and fold settings;
// grids of tiles, in the order in which they are rendered, and the depths of records. And a tile: its records
// are put in order, folded group by group, and resolved into the frame's pixels.
#pragma once

#include <map>
#include <tuple>

#include "core/progress.h"
#include "render/fold.h"
#include "render/footprint.h"
#include "render/frame.h"
#include "render/lod.h"
#include "render/project.h"
#include "render/render.h"
#include "render/resolve.h"
#include "render/scatter.h"
#include "render/screen_splat.h"

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
/// can be estimated. With tile_done those nearest to the middle come first, and what has many splats is cut
/// so that its first tiles come soon.
struct Bands {
    std::vector<TileGrid> grids;
    std::int64_t records = 0;  // that the largest will take, roughly
};
Bands make_bands(const FrameJob& job);

/// Records that the splats near a depth will leave.
struct DepthShare {
    std::uint32_t depth;
    double records;
};

/// A frame comes in slabs of depth where its splats are not all in memory; where the cuts are changes no
/// pixel, for the fold goes on from slab to slab.
struct DepthSample {
    std::vector<DepthShare> shares;  // near to far

    double records() const;
    /// Cuts that leave each slab no more than so many records, as far as the sample can tell; one range where
    /// all fit. Near to far, together all depths from `first` on.
    std::vector<DepthRange> cut(double most_records, std::uint32_t first) const;
    /// The range in two of about equal records. first < last.
    std::pair<DepthRange, DepthRange> halve(const DepthRange& range) const;
};

/// A sample of the layers' splats by depth.
DepthSample sample_depths(std::span<const LayerProjection> layers, const TileGrid& grid,
                          const Progress& progress);

// ---- one tile

/// Scratch of one worker.
struct TileWorker {
    std::vector<std::span<const ScreenSplat>> runs;  // of the tile's records
    SplatSorter sorter;
    TilePlanes planes;
    TileResolver resolver;
};
std::vector<TileWorker> make_tile_workers(const FrameJob& job);

/// The tiles in the order in which they are rendered: with tile_done from the middle of the frame outwards.
std::vector<std::int64_t> tile_order(const FrameJob& job, const TileGrid& grid);

/// A tile whose records are all there.
void render_tile(const FrameJob& job, const TileBins& bins, std::int64_t tile, TileWorker& worker,
                 RenderedFrame& frame);

/// All tiles of a band between its slabs of depth.
class CarriedTiles {
  public:
    CarriedTiles(const FrameJob& job, const TileGrid& grid)
        : job_(job), grid_(grid), planes_(std::size_t(grid.tiles()) * job.groups.size()) {}

    /// Folds a slab's records into a tile. Different tiles may be folded at once.
    void fold_slab(const TileBins& bins, std::int64_t tile, TileWorker& worker);
    /// After the last slab.
    void finish(std::int64_t tile, TileWorker& worker, RenderedFrame& frame);

  private:
    TilePlanes& planes_of(std::int64_t tile, std::size_t group) {
        return planes_[std::size_t(tile) * job_.groups.size() + group];
    }

    const FrameJob& job_;
    TileGrid grid_;
    std::vector<TilePlanes> planes_;  // by tile and group; of width 0 until a splat comes
};

}  // namespace astrosplat
