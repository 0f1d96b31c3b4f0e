// The closest points of all positions of one lattice block. In: the block and the meshes' index. Out: one
// answer per position, equal to ClosestPointIndex::closest_brute_force, whichever way it was found.
#pragma once

#include "generate/block_cull.h"
#include "generate/block_kernel.h"
#include "generate/closest_point.h"
#include "generate/lattice.h"

namespace astrosplat {

/// Answers for one block's positions; places beyond the lattice's end are not kept.
void query_block(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, BlockScratch& scratch, BlockAnswers& answers);

}  // namespace astrosplat
