// Splats into voxels, for volume renderers. A layer's shaded splats, a camera and an exposure give Gaussian
// bodies in world space with what each hides and shines over its whole footprint on the frame; bodies and the
// voxels' side give density and light of those voxels that any of them reaches, in blocks. The same bits for
// any number of threads.
#pragma once

#include <glm/vec3.hpp>

#include "core/buffer.h"
#include "core/progress.h"
#include "gaussians/gaussians.h"

namespace astrosplat {

/// A symmetric 3x3 matrix: xx, yy, zz, xy, xz, yz.
using Symmetric = std::array<double, 6>;

struct VoxelSplat {
    glm::dvec3 place{0.0};   // scene units, world space
    glm::vec3 ray{0.0f};     // unit vector along which the camera sees it
    bool ball = true;        // its covariance is variance[0] times the unit matrix
    Symmetric covariance{};  // square scene units
    /// Of the peak of its footprint, as in SplatAppearance.
    float shows = 0.0f, hides = 0.0f;
    glm::vec3 light{0.0f};
};

/// Appends those of a layer that are seen, in its order; others are counted. Gaussians that were read count
/// with the footprint that the camera sees. No stars. Throws InputError (memory).
void add_voxel_splats(const RenderLayer& layer, const Camera& camera, double gain,
                      std::vector<VoxelSplat>& out, BakeCounts& counts);

/// The voxel's side where none is wanted: the median standard deviation of the splats, but between a 512th
/// and a 128th of the longest side of the box around them. There must be one.
double default_voxel_size(const std::vector<VoxelSplat>& splats);

/// t of hidden = Ein(t), for 0 <= hidden <= 1.5.
double optical_depth_that_hides(double hidden);

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
