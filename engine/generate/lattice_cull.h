// Generation: blocks of a lattice near the meshes, the closest point of each of their positions, its colour
// (README.md). Blocks near no mesh are dropped from the top of an octree, where the closest point of a
// block's middle is too far away. A block's positions, corners or centres, stand in groups of eight
// neighbours, 2 x 2 x 2, so that a vector holds one coordinate of a group. In: textured meshes and a lattice.
// Out: one answer per position, to the bits that of closest_on_triangle tried on every triangle, and the
// picture there; what is kept, batch by batch in order of id, for whole sets and for files written
// in parts (generate.h).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/buffer.h"
#include "core/progress.h"
#include "generate/kept_store.h"
#include "generate/lattice.h"
#include "generate/triangle_tree.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

struct SurfaceTriangle {
    glm::vec2 uv_a, uv_b, uv_c;  // at the corners
    glm::vec3 normal;            // unit, by the face's winding; +y for faces without area
    glm::vec2 box_texels;        // side of Filter::area's box: a voxel's side times the local texels per unit
    std::uint32_t mesh;
    const Texture* texture;
    const Camera* camera;  // uv = "camera"; null: the face's own (u,v)
};

/// One entry for each triangle of all meshes in order. `spacing` is the voxel's sides in scene units. The
/// result points into `meshes`.
Buffer<SurfaceTriangle> surface_triangles(std::span<const TexturedMesh> meshes, const glm::dvec3& spacing);

/// Facts about a set as a whole that follow from its pictures: SplatSetFacts::divided, credit and origin.
void describe_pictures(std::span<const TexturedMesh> meshes, SplatSetFacts& facts);

/// (u,v) of a position whose closest point is there: that point's, or, where a camera took the picture, the
/// position's own; empty behind that camera.
std::optional<glm::vec2> uv_of(const SurfaceTriangle& triangle, const glm::dvec2& barycentric,
                               const glm::dvec3& position);

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
    /// how many positions no picture shows, which are not kept. The same for any thread count.
    /// Throws Cancelled.
    std::int64_t run(const std::vector<LatticeBlock>& blocks, const Progress& progress, const TakeKept& take,
                     KeptWatcher* watcher = nullptr) const;

  private:
    Lattice lattice_;
    CullSettings settings_;
    TriangleTree tree_;
    Buffer<SurfaceTriangle> surface_;
};

}  // namespace astrosplat
