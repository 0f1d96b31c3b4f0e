// Which parts of a lattice can lie near a mesh at all: an octree of lattice blocks, dropped from the top
// where no place near a block's middle is found. In: lattice, index, distance. Out: the blocks that are left,
// each with the clusters of triangles that can matter to it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/buffer.h"
#include "core/progress.h"
#include "generate/block_kernel.h"
#include "generate/closest_point.h"
#include "generate/lattice.h"

namespace astrosplat {

/// What a cull of a lattice asks for.
struct CullSettings {
    double max_distance;  // scene units, >= 0
    double jitter;        // 0..1 of half a voxel
    std::uint32_t seed;
};

/// A block of block_cells^3 cells: the corners and centres whose index divided by block_cells is `at`.
struct LatticeBlock {
    glm::i64vec3 at;
    double distance;                // of the ball's middle from the meshes, at most; scene units
    std::uint32_t near_slot;        // of a triangle about there
    std::uint32_t cluster_count;    // 0: not known, or too many to be kept
    const std::uint32_t* clusters;  // at least those with a triangle that is closest to one of the positions
    static constexpr std::size_t most_clusters = 1024;
};

/// Blocks and what they point to.
struct NearBlocks {
    Buffer<LatticeBlock> blocks;
    std::vector<Buffer<std::uint32_t>> clusters;
};

/// A ball, and a box with the same middle, around all positions, after jitter, of the `cells`^3 cells from
/// cell `first` on.
struct BlockBall {
    glm::dvec3 center;
    double radius;
    glm::dvec3 half;  // of the box's sides
};
BlockBall block_ball(const Lattice& lattice, double jitter, const glm::i64vec3& first, std::int64_t cells);

/// How near a triangle must come to the ball's middle to be closest to one of its positions, when the meshes
/// are `distance` away from there.
double candidate_radius(const CullSettings& settings, const BlockBall& ball, double distance);

/// The blocks that may hold positions within max_distance, ordered by (z, y, x). Costs time and memory in
/// proportion to their number.
NearBlocks blocks_near(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                       const Progress& progress);

}  // namespace astrosplat
