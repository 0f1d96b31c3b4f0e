// A layer's splats as bodies that fill voxels. In: shaded layers, a camera and an exposure. Out: Gaussians in
// world space with what each hides and shines over its whole footprint on the frame; and, for a side of the
// voxels, how each weighs in every voxel and what it brings.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

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

/// Area that the weight e^(-d^2 / 2) of a covariance has on a frame across `ray`, in its square units:
/// 2 pi sqrt(ray . adj(covariance) ray).
double footprint_area(const Symmetric& covariance, const glm::dvec3& ray);

/// The voxel's side where none is wanted: the median standard deviation of the splats, but between a 512th
/// and a 128th of the longest side of the box around them. There must be one.
double default_voxel_size(const std::vector<VoxelSplat>& splats);

/// Sums of a voxel: density, three channels of light, and what shows.
inline constexpr int voxel_channels = 5;

/// In voxels; voxel (i, j, k) is sampled at the point (i, j, k).
struct VoxelBody {
    glm::dvec3 centre{0.0};
    glm::ivec3 lo{0}, hi{0};  // voxels that it reaches, both included
    bool ball = true;
    Symmetric precision{};                       // inverse of the covariance
    std::array<double, voxel_channels> share{};  // what it brings to a voxel of weight 1
};

/// The whole of what a splat adds, square scene units.
struct Brought {
    double density = 0.0;
    glm::dvec3 emission{0.0};
};

/// How far a splat may reach from its centre, scene units.
double voxel_reach(const Symmetric& covariance, double voxel_size);

/// The body of a splat; its weights times its shares, times the voxel's volume, sum up to what it brings.
VoxelBody voxel_body(const VoxelSplat& splat, double voxel_size, Brought& brought);

/// e^(-d^2 / 2) of a ball along axis k at voxel i; its weight is the product of three.
double weight_along(const VoxelBody& body, int k, int i);
/// The weight of a body that is no ball, 0 beyond four standard deviations.
double weight_of_ellipsoid(const VoxelBody& body, const glm::ivec3& voxel);

/// t of hidden = Ein(t), for 0 <= hidden <= 1.5.
double optical_depth_that_hides(double hidden);

}  // namespace astrosplat
