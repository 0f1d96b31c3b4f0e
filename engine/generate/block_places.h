// The positions of a lattice block, corners or centres, compiled once for every instruction set with the same
// bits on each. In: lattice, block. Out: jittered positions in groups of eight neighbours, 2 x 2 x 2, so that
// a vector holds one coordinate of a group.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "generate/block_cull.h"
#include "generate/lattice.h"

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

}  // namespace astrosplat
