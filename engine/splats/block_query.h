// The closest points of all positions of one lattice block. In: the block and the meshes' index. Out: one
// answer per position, equal to ClosestPointIndex::closest_brute_force, whichever way it was found.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "splats/block_cull.h"
#include "splats/closest_point.h"
#include "splats/lattice.h"

namespace astrosplat {

/// One position that was looked at. `closest.triangle` is ClosestPoint::none where it is not kept.
struct FoundPoint {
    ClosestPoint closest;
    glm::vec3 position;  // scene units, jittered, rounded
};

constexpr std::int64_t block_points = block_cells * block_cells * block_cells;  // of each kind

/// Answers in order (z, y, x) of the block's cells; places beyond the lattice's end are not kept.
struct BlockAnswers {
    std::array<FoundPoint, block_points> corners, centres;
};

void query_block(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, BlockAnswers& answers);

}  // namespace astrosplat
