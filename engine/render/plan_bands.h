// How a frame is cut for rendering: the size of its tiles, and bands of rows of them. In: a job. Out: grids
// of tiles, in the order in which they are rendered. Changes no pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame_job.h"
#include "render/scatter.h"

namespace astrosplat {

/// The frame's tiles, and the records they will take, roughly.
struct Tiles {
    TileGrid grid;
    std::int64_t records = 0;
};
Tiles choose_tiles(const FrameJob& job);

/// The frame in bands, each of some rows of tiles, so that what they take keeps to the memory limit as far as
/// can be told before. With tile_done those nearest to the middle come first, and what has many splats is cut
/// so that its first tiles come soon.
struct Bands {
    std::vector<TileGrid> grids;
    std::int64_t records = 0;  // that the largest will take, roughly
};
Bands make_bands(const FrameJob& job);

}  // namespace astrosplat
