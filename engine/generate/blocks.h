// The positions of a lattice block, corners or centres, and their closest points (README.md). In: lattice,
// block, and the tree of triangles. Out: jittered positions in groups of eight neighbours, 2 x 2 x 2, so that
// a vector holds one coordinate of a group; one answer per position, to the bits that of closest_on_triangle
// tried on every triangle. Compiled once for every instruction set with the same bits on each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "generate/lattice.h"
#include "generate/lattice_cull.h"
#include "generate/triangle_tree.h"

namespace astrosplat {

constexpr std::size_t block_positions = block_cells * block_cells * block_cells;

/// The two kinds of lattice positions; corners have the lower ids.
enum class Positions { corners, centres };

/// Where position (i, j, k) of a block stands in arrays: group by group.
constexpr std::size_t block_slot(std::size_t i, std::size_t j, std::size_t k) {
    return ((k / 2 * 2 + j / 2) * 2 + i / 2) * 8 + k % 2 * 4 + j % 2 * 2 + i % 2;
}

/// One block's positions of one kind and their closest points, by block_slot. `triangle` is
/// ClosestPoint::none where nothing is near enough.
struct BlockAnswers {
    template <class T>
    using Array = std::array<T, block_positions>;
    alignas(64) Array<double> x, y, z;  // scene units, jittered
    alignas(64) Array<double> distance_squared, v, w;
    Array<std::uint32_t> triangle;
};

/// Fills in the positions, each moved by jitter * half a voxel * uniform[-1, 1) per axis, hashed from (seed,
/// id); also those beyond the lattice's end.
void place_block(const Lattice& lattice, const CullSettings& settings, const LatticeBlock& block,
                 Positions kind, BlockAnswers& answers);

/// Answers for one block's positions of one kind; places beyond the lattice's end are not kept. `scratch`
/// saves allocations from call to call.
void query_block(const TriangleTree& tree, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, Positions kind, std::vector<std::uint32_t>& scratch,
                 BlockAnswers& answers);

}  // namespace astrosplat
