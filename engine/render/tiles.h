// A tile of the frame: its records are put in order, folded group by group, and resolved into the frame's
// pixels. Where the frame comes in slabs of depth, the state of the fold stays between them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/fold.h"
#include "render/frame.h"
#include "render/frame_job.h"
#include "render/resolve.h"
#include "render/scatter.h"
#include "render/splat_sorter.h"

namespace astrosplat {

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
        : job_(job), grid_(grid), planes_(static_cast<std::size_t>(grid.tiles()) * job.groups.size()) {}

    /// Folds a slab's records into a tile. Different tiles may be folded at once.
    void fold_slab(const TileBins& bins, std::int64_t tile, TileWorker& worker);
    /// After the last slab.
    void finish(std::int64_t tile, TileWorker& worker, RenderedFrame& frame);

  private:
    TilePlanes& planes_of(std::int64_t tile, std::size_t group) {
        return planes_[static_cast<std::size_t>(tile) * job_.groups.size() + group];
    }

    const FrameJob& job_;
    TileGrid grid_;
    std::vector<TilePlanes> planes_;  // by tile and group; of width 0 until a splat comes
};

}  // namespace astrosplat
