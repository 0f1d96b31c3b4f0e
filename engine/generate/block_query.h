// The closest points of a lattice block's positions (README.md). In: the block and the tree of triangles.
// Out: one answer per position, to the bits that of closest_on_triangle tried on every triangle, with the
// same bits on every instruction set.
#pragma once

#include "generate/block_cull.h"
#include "generate/block_places.h"
#include "generate/lattice.h"
#include "generate/triangle_tree.h"

namespace astrosplat {

/// Answers for one block's positions of one kind; places beyond the lattice's end are not kept. `scratch`
/// saves allocations from call to call.
void query_block(const TriangleTree& tree, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, Positions kind, std::vector<std::uint32_t>& scratch,
                 BlockAnswers& answers);

}  // namespace astrosplat
