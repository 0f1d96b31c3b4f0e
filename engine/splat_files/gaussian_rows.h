// Rows of Gaussians while files that place them in nodes are read. In: how many, and a node's matrix. Out: a
// set with room for them, and rows that stand where the node puts them.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>

#include "splats/splat_set.h"

namespace astrosplat {

/// Room for `count` Gaussians, with harmonics of 0 where they are `directional`; distance is 0, id the row.
/// Throws InputError where the memory of `what` is not there.
SplatSet room_for_gaussians(std::int64_t count, bool directional, const std::string& what);

/// How a node changes what it holds.
struct GaussianPlacement {
    double scale = 1.0;
    glm::dmat3 turn{1.0};  // orthonormal columns; may mirror
    glm::dvec3 place{0.0};
    bool turns = false;
};

/// Empty where the matrix scales axes differently: a Gaussian and its harmonics would become others.
std::optional<GaussianPlacement> gaussian_placement(const glm::dmat4& world);

/// Moves rows [begin, end), whose numbers are a file's: positions, scales (not their logarithms), rotations
/// and harmonics.
void place_gaussians(SplatSet& set, std::size_t begin, std::size_t end, const GaussianPlacement& placement);

}  // namespace astrosplat
