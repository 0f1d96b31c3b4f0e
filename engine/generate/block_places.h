// The positions of a lattice block, compiled once for every instruction set with the same bits on each. In:
// coordinates along the axes, ids. Out: jittered positions in groups of sixteen neighbours, the corners and
// the centres of 2 x 2 x 2 cells, so that one vector holds one coordinate of a group.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace astrosplat {

constexpr std::int64_t block_cells = 4;
constexpr std::size_t block_positions = 2 * block_cells * block_cells * block_cells;

/// The two kinds of lattice positions; corners have the lower ids.
enum class Positions { corners, centres };

/// Where the position of a block's cell (i, j, k) stands in arrays: group by group, corners before centres.
constexpr std::size_t block_slot(Positions kind, std::size_t i, std::size_t j, std::size_t k) {
    const std::size_t group = (k / 2 * 2 + j / 2) * 2 + i / 2, of_kind = kind == Positions::centres ? 1 : 0;
    return (group * 2 + of_kind) * 8 + k % 2 * 4 + j % 2 * 2 + i % 2;
}

/// The positions of a block of one kind: coordinates along the axes before jitter, and ids.
struct KindPlaces {
    std::array<double, block_cells> x, y, z;
    std::uint64_t first_id, row_ids, slice_ids;  // id = first + i + j * row_ids + k * slice_ids
};

struct BlockPlaces {
    KindPlaces corners, centres;
    glm::dvec3 half_range;  // of the jitter, scene units
    std::uint32_t seed;
};

/// One block's positions and their closest points, by block_slot. `triangle` is ClosestPoint::none where
/// nothing is near enough.
struct BlockAnswers {
    template <class T>
    using Array = std::array<T, block_positions>;
    alignas(64) Array<double> x, y, z;  // scene units, jittered
    alignas(64) Array<double> distance_squared, v, w;
    alignas(64) Array<std::uint32_t> triangle;
};

/// Fills in the positions, to the bits of jittered_position.
void place_block(const BlockPlaces& places, BlockAnswers& answers);

}  // namespace astrosplat
