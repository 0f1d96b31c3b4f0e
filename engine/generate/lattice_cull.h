// Generation: blocks of a lattice near the meshes, the closest point of each of their positions, its colour.
// Blocks near no mesh are dropped from the top of an octree, where the closest point of a block's middle is
// too far away. In: textured meshes and a lattice. Out: what is kept, batch by batch in order of id, for
// whole sets and for files written in parts (generate.h).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/progress.h"
#include "generate/kept_store.h"
#include "generate/lattice.h"
#include "generate/surface.h"
#include "generate/triangle_tree.h"
#include "source/textured_mesh.h"

namespace astrosplat {

constexpr std::int64_t block_cells = 4;

/// Arguments of a cull of a lattice.
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

/// A batch: the runs of all threads in any order. They are gone after the call.
using TakeKept = std::function<void(std::span<const KeptStore::Run> runs)>;

class LatticeCull {
  public:
    static constexpr std::size_t batch_blocks = 1u << 13;  // about this many are kept apart

    /// The meshes stay where they are.
    LatticeCull(std::span<const TexturedMesh> meshes, const Lattice& lattice, const CullSettings& settings);

    /// The blocks that hold cells of `range` and may hold positions within max_distance.
    std::vector<LatticeBlock> blocks(const CellRange& range, const Progress& progress) const;

    /// All corners of the blocks, then all centres, as their ids ask for; each time batch by batch. Returns
    /// how many positions no picture shows, which are not kept. The same for any thread count. Throws
    /// Cancelled.
    std::int64_t run(const std::vector<LatticeBlock>& blocks, const Progress& progress, const TakeKept& take,
                     KeptWatcher* watcher = nullptr) const;

  private:
    Lattice lattice_;
    CullSettings settings_;
    TriangleTree tree_;
    Buffer<SurfaceTriangle> surface_;
};

}  // namespace astrosplat
