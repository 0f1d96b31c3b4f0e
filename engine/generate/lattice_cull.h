// Generation: blocks of a lattice near the meshes, the closest point of each of their positions, its colour.
// In: textured meshes and a lattice. Out: what is kept, batch by batch in order of id, for sets that are made
// as a whole (columns.h) and for files that are written in parts (write_columns.h).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "generate/block_cull.h"
#include "generate/kept_store.h"
#include "generate/lattice.h"
#include "generate/surface.h"
#include "generate/triangle_tree.h"
#include "source/textured_mesh.h"

namespace astrosplat {

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
