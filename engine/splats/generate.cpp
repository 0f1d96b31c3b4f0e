// Generation: blocks of the lattice near the meshes, the closest point of each of their positions, its
// colour; then everything in order of id. Threads take short rows of blocks; what they write depends on the
// row alone.
#include "splats/generate.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"
#include "splats/block_cull.h"
#include "splats/block_query.h"
#include "splats/closest_point.h"
#include "splats/kept_store.h"
#include "splats/surface.h"

namespace astrosplat {
namespace {

constexpr std::size_t longest_row = 64;  // blocks: their answers stay in the second-level cache

/// Blocks begin .. end-1, neighbours in (y, z) and ascending in x.
struct BlockRow {
    std::size_t begin, end;
};

std::vector<BlockRow> rows_of(const std::vector<LatticeBlock>& blocks) {
    std::vector<BlockRow> rows;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const bool joins = !rows.empty() && i - rows.back().begin < longest_row &&
                           blocks[i - 1].at.y == blocks[i].at.y && blocks[i - 1].at.z == blocks[i].at.z;
        if (!joins) rows.push_back({i, i});
        rows.back().end = i + 1;
    }
    return rows;
}

struct Worker {
    std::vector<BlockAnswers> answers;
    std::int64_t zero_alpha = 0;
};

class Generator {
  public:
    Generator(const ClosestPointIndex& index, const std::vector<SurfaceTriangle>& surface,
              const Lattice& lattice, const CullSettings& settings)
        : index_(index), surface_(surface), lattice_(lattice), settings_(settings) {}

    void run(const LatticeBlock* blocks, std::size_t count, Worker& worker, KeptStore& kept) const {
        worker.answers.resize(std::max(worker.answers.size(), count));
        for (std::size_t i = 0; i < count; ++i) {
            query_block(index_, lattice_, settings_, blocks[i], worker.answers[i]);
        }
        store(blocks, count, false, worker, kept);
        store(blocks, count, true, worker, kept);
    }

  private:
    // Walks the answers in order of id: lattice rows across all blocks.
    void store(const LatticeBlock* blocks, std::size_t count, bool centres, Worker& worker,
               KeptStore& kept) const {
        for (std::int64_t k = 0; k < block_cells; ++k) {
            for (std::int64_t j = 0; j < block_cells; ++j) {
                kept.begin_run();
                for (std::size_t b = 0; b < count; ++b) {
                    const glm::i64vec3 first = blocks[b].at * block_cells + glm::i64vec3(0, j, k);
                    const std::uint64_t id =
                        centres ? centre_id(lattice_, first) : corner_id(lattice_, first);
                    const BlockAnswers& answers = worker.answers[b];
                    const FoundPoint* found = centres ? answers.centres.data() : answers.corners.data();
                    found += (k * block_cells + j) * block_cells;
                    for (std::uint64_t i = 0; i < block_cells; ++i) {
                        if (found[i].closest.triangle != ClosestPoint::none)
                            store(found[i], id + i, worker, kept);
                    }
                }
            }
        }
    }

    void store(const FoundPoint& found, std::uint64_t id, Worker& worker, KeptStore& kept) const {
        const SurfaceTriangle& surface = surface_[found.closest.triangle];
        const glm::vec2 uv = uv_at(surface, found.closest.barycentric);
        const TextureSample picture = sample(*surface.texture, uv, surface.box_texels);
        if (picture.alpha == 0.0f) {
            ++worker.zero_alpha;
            return;
        }
        const auto distance = static_cast<float>(std::sqrt(found.closest.distance_squared));
        kept.add(
            {found.position, picture.color, picture.alpha, distance, id, uv, surface.normal, surface.mesh});
    }

    const ClosestPointIndex& index_;
    const std::vector<SurfaceTriangle>& surface_;
    const Lattice& lattice_;
    const CullSettings& settings_;
};

void describe_set(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  SplatSet& set) {
    set.spacing = lattice.spacing();
    set.max_distance = max_distance;
    set.generated = true;
    set.test_positions = lattice.positions();
    std::vector<std::string> credits;
    for (const TexturedMesh& m : meshes) {
        for (const Texture& texture : m.textures) {
            set.divided = set.divided || texture.divided;
            const bool known = std::find(credits.begin(), credits.end(), texture.credit) != credits.end();
            if (texture.credit.empty() || known) continue;
            set.credit += (credits.empty() ? "" : "; ") + texture.credit;
            credits.push_back(texture.credit);
        }
    }
}

}  // namespace

std::int64_t generate_memory_bytes(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                                   double max_distance) {
    double triangles = 0.0;
    for (const TexturedMesh& m : meshes) triangles += static_cast<double>(m.mesh.triangles.size());
    const double per_splat =
        1.25 * static_cast<double>(kept_splat_bytes);  // one array exists twice at the end
    const double per_triangle = sizeof(TriangleShape) + sizeof(SurfaceTriangle) + 200.0;  // and Embree's tree
    const double bytes = expected_kept(lattice, meshes, max_distance) * per_splat + triangles * per_triangle;
    return static_cast<std::int64_t>(std::min(bytes, 9e18));
}

SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress) {
    claim_memory(generate_memory_bytes(meshes, lattice, max_distance), "generating splats");
    std::vector<const Mesh*> shapes;
    for (const TexturedMesh& m : meshes) shapes.push_back(&m.mesh);
    const ClosestPointIndex index(shapes);
    const std::vector<SurfaceTriangle> surface = surface_triangles(meshes, index, lattice.spacing());
    const CullSettings settings{max_distance, jitter, seed};
    const std::vector<LatticeBlock> blocks = blocks_near(index, lattice, settings, progress);
    const std::vector<BlockRow> rows = rows_of(blocks);

    const Generator generator(index, surface, lattice, settings);
    std::vector<Worker> workers(static_cast<std::size_t>(thread_count()));
    std::vector<KeptStore> stores(workers.size());
    std::atomic<std::int64_t> done{0};
    parallel_for(static_cast<std::int64_t>(rows.size()), [&](std::int64_t row, int worker) {
        progress.check();
        const auto [begin, end] = rows[static_cast<std::size_t>(row)];
        const auto w = static_cast<std::size_t>(worker);
        generator.run(&blocks[begin], end - begin, workers[w], stores[w]);
        progress.at(static_cast<double>(++done) / static_cast<double>(rows.size()));
    });

    SplatSet set;
    gather(stores, set);
    describe_set(meshes, lattice, max_distance, set);
    for (const Worker& worker : workers) set.zero_alpha += worker.zero_alpha;
    check_consistent(set);
    return set;
}

}  // namespace astrosplat
