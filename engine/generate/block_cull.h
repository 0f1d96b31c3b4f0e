// Which parts of a lattice can lie near a mesh at all: an octree of lattice blocks, dropped from the top
// where the closest point of a block's middle is too far away. In: lattice, tree, distance. Out: the blocks
// that are left.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "core/progress.h"
#include "generate/lattice.h"
#include "generate/triangle_tree.h"

namespace astrosplat {

constexpr std::int64_t block_cells = 4;

/// What a cull of a lattice asks for.
struct CullSettings {
    double max_distance;  // scene units, >= 0
    double jitter;        // 0..1 of half a voxel
    std::uint32_t seed;
};

/// A block of block_cells^3 cells: the corners and centres whose index divided by block_cells is `at`.
struct LatticeBlock {
    glm::i64vec3 at;
    std::uint32_t near_slot;  // of the triangle that is closest to the block's middle
};

/// A ball around all positions, after jitter, of the `cells`^3 cells from cell `first` on.
struct BlockBall {
    glm::dvec3 center;
    double radius;
};
BlockBall block_ball(const Lattice& lattice, double jitter, const glm::i64vec3& first, std::int64_t cells);

/// Cells lo .. hi-1 of each axis; by default all.
struct CellRange {
    glm::i64vec3 lo{0}, hi{std::numeric_limits<std::int64_t>::max()};
};

/// The blocks that hold cells of `range` and may hold positions within max_distance, ordered by (z, y, x).
/// Costs time and memory in proportion to their number.
std::vector<LatticeBlock> blocks_near(const TriangleTree& tree, const Lattice& lattice,
                                      const CullSettings& settings, const Progress& progress,
                                      const CellRange& range = {});

}  // namespace astrosplat
