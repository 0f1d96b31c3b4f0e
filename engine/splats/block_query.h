// The closest points of all positions of one lattice block. In: the block and the meshes' index. Out: one
// answer per position, equal to ClosestPointIndex::closest_brute_force, whichever way it was found.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "splats/block_cull.h"
#include "splats/box_scan.h"
#include "splats/closest_point.h"
#include "splats/lattice.h"

namespace astrosplat {

/// The two kinds of lattice positions; corners have the lower ids.
enum class Positions { corners, centres };

/// One position that was looked at. `closest.triangle` is ClosestPoint::none where it is not kept.
struct FoundPoint {
    ClosestPoint closest;
    glm::vec3 position;  // scene units, jittered, rounded
};

/// One block's positions of one kind in order (z, y, x); places beyond the lattice's end are not kept.
using BlockAnswers = std::array<FoundPoint, block_cells * block_cells * block_cells>;

/// A thread's working memory.
struct BlockScratch {
    BoxList candidates;
    NearBoxes near_boxes;
};

void query_block(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, Positions kind, BlockScratch& scratch, BlockAnswers& answers);

}  // namespace astrosplat
