// The cull's positions become a set.
#include "generate/generate.h"

#include <algorithm>
#include <vector>

#include "core/memory.h"
#include "generate/block_places.h"
#include "generate/columns.h"
#include "generate/lattice_cull.h"
#include "generate/triangle_tree.h"

namespace astrosplat {
namespace {

// Adds what is kept to the set.
void run_cull(const LatticeCull& cull, const Progress& progress, KeptWatcher* watcher, SplatSet& set) {
    const std::vector<LatticeBlock> blocks = cull.blocks({}, progress);
    reserve(set, blocks.size() * 2 * block_positions);
    const auto append = [&](std::span<const KeptStore::Run> runs) { append_sorted(runs, set); };
    set.zero_alpha += cull.run(blocks, progress, append, watcher);
}

/// What so many positions take, and a batch of them that exists twice.
double bytes_of_positions(double positions) {
    constexpr double most_in_batch =
        0.5 * LatticeCull::batch_blocks * block_positions;  // a surface keeps half of a block
    return positions * static_cast<double>(bytes_per_splat(is_generated)) +
           std::min(0.5 * positions, most_in_batch) * static_cast<double>(sizeof(KeptSplat));
}

}  // namespace

SplatSetFacts facts_of_columns(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                               double max_distance) {
    SplatSetFacts facts;
    facts.spacing = lattice.spacing();
    facts.max_distance = max_distance;
    facts.generated = true;
    facts.test_positions = lattice.positions();
    describe_pictures(meshes, facts);
    return facts;
}

std::int64_t columns_memory_bytes(std::int64_t positions) {
    return static_cast<std::int64_t>(bytes_of_positions(static_cast<double>(positions)));
}

std::int64_t columns_memory_bytes(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                                  double max_distance) {
    double triangles = 0.0;
    for (const TexturedMesh& m : meshes) triangles += static_cast<double>(m.mesh.triangles.size());
    const double per_triangle =
        sizeof(TreeTriangle) + sizeof(SurfaceTriangle) + 6.9 * sizeof(float);  // 8/7 boxes
    const double bytes =
        bytes_of_positions(expected_positions(lattice, meshes, max_distance)) + triangles * per_triangle;
    return static_cast<std::int64_t>(std::min(bytes, 9e18));
}

KeptCounts count_kept(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance) {
    KeptCounts counts;
    const LatticeCull cull(meshes, lattice, {max_distance, 1.0, 1});
    const std::int64_t unseen = cull.run(cull.blocks({}, {}), {}, [&](std::span<const KeptStore::Run> runs) {
        for (const KeptStore::Run& run : runs) {
            counts.kept += static_cast<std::int64_t>(run.count);
            counts.lit += static_cast<std::int64_t>(run.lit);
        }
    });
    counts.kept += unseen;
    return counts;
}

Columns make_columns(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                     double jitter, std::uint32_t seed, const Progress& progress, KeptWatcher* watcher) {
    claim_memory(columns_memory_bytes(meshes, lattice, max_distance), "generating splats");
    Columns columns;
    static_cast<SplatSetFacts&>(columns.splats) = facts_of_columns(meshes, lattice, max_distance);
    if (watcher) watcher->begins(columns.splats, lattice.box);
    run_cull(LatticeCull(meshes, lattice, {max_distance, jitter, seed}), progress, watcher, columns.splats);
    check_consistent(columns.splats);
    if (watcher) show_end(columns, *watcher);
    return columns;
}

SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress) {
    return lit_splats(make_columns(meshes, lattice, max_distance, jitter, seed, progress));
}

}  // namespace astrosplat
