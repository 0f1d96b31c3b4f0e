// One splat among voxels. In: a splat and the voxels' side. Out: how it weighs in each voxel, and what it
// brings.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "volumes/voxel_splats.h"

namespace astrosplat {

/// What a voxel collects: density, three channels of light, and what shows.
inline constexpr int voxel_channels = 5;

/// In voxels; voxel (i, j, k) is sampled at the point (i, j, k).
struct VoxelBody {
    glm::dvec3 centre{0.0};
    glm::ivec3 lo{0}, hi{0};  // voxels that it reaches, both included
    bool ball = true;
    Symmetric precision{};                       // inverse of the covariance
    std::array<double, voxel_channels> share{};  // what it brings to a voxel of weight 1
};

/// What a splat brings in all, square scene units.
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
