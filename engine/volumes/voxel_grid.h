// Splats into voxels. In: splats and the voxels' side. Out: density and light of those voxels that any of
// them reaches, in blocks, for volume renderers. The same bits for any number of threads.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/buffer.h"
#include "core/progress.h"
#include "volumes/voxel_splats.h"

namespace astrosplat {

inline constexpr int block_side = 8;                                       // voxels
inline constexpr int block_voxels = block_side * block_side * block_side;  // x slowest, z fastest

/// A block's first voxel is (8 x, 8 y, 8 z) of its place; voxel (i, j, k) stands for the cube around the
/// point voxel_size * (i, j, k) of the world.
struct VoxelGrid {
    double voxel_size = 1.0;         // scene units
    std::vector<glm::ivec3> blocks;  // in ascending order of x, y, z
    Buffer<float> density;  // what is hidden per scene unit of depth (extinction), of each block's voxels
    Buffer<glm::vec3> emission;  // linear light per scene unit of depth
    Buffer<glm::vec3> color;     // straight: emission / density, where all that shines hides as much
    double density_put = 0.0;    // sums that were to be spread, times voxel volume: square scene units
    glm::dvec3 emission_put{0.0};
};

/// Each splat becomes a Gaussian body: its own, convolved with one of half a voxel's standard deviation,
/// sampled at the voxels' centres out to four standard deviations, and divided by the sum, so that nothing is
/// lost. Seen through the grid alone it hides and shines what it does on the frame: a body of optical depth t
/// e^(-q), q over the footprint, hides Ein(t) = sum of (-1)^(k+1) t^k / (k k!) times its area, which is
/// solved for t. Where splats are thin or smaller than voxels t is simply what they hide. `voxel_size` > 0.
/// Throws InputError (memory, or more than 2^20 voxels from the origin), Cancelled.
VoxelGrid fill_voxels(const std::vector<VoxelSplat>& splats, double voxel_size,
                      const Progress& progress = {});

}  // namespace astrosplat
