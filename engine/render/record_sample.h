// How many records splats will leave, told from a sample of them. In: projections, and tiles of a size. Out:
// numbers of records, whole or by depth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "render/depth_slabs.h"
#include "render/scatter.h"

namespace astrosplat {

/// Records that the layers will take in tiles of each of the sizes, estimated from every 64th block
/// of splats, and from the sample of those that come by the block.
std::vector<std::int64_t> estimate_records(std::span<const LayerProjection> layers, const TileGrid& grid,
                                           std::span<const int> tile_sizes_px, const Progress& progress);

/// The same by depth.
DepthSample sample_depths(std::span<const LayerProjection> layers, const TileGrid& grid,
                          const Progress& progress);

}  // namespace astrosplat
