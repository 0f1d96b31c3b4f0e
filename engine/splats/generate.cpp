// Generation: blocks of the lattice near the meshes, the closest point of each of their positions, its
// colour; then everything in order of id. Threads take short rows of blocks; what they write depends on the
// row alone.
#include "splats/generate.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"
#include "splats/block_cull.h"
#include "splats/block_query.h"
#include "splats/closest_point.h"
#include "splats/kept_store.h"
#include "splats/kept_watcher.h"
#include "splats/surface.h"

namespace astrosplat {
namespace {

constexpr std::size_t longest_row = 32;         // blocks: their answers stay in the second-level cache
constexpr std::size_t batch_blocks = 1u << 13;  // about this many are kept apart before they join the set

/// Blocks begin .. end-1: a row has the same (y, z) and ascending x, a batch is whole layers of the same z.
struct BlockRange {
    std::size_t begin, end;
};

// Rows that lie above each other follow each other: they need much the same triangles.
std::vector<BlockRange> rows_of(const Buffer<LatticeBlock>& blocks, const BlockRange& batch) {
    std::vector<BlockRange> rows;
    for (std::size_t i = batch.begin; i < batch.end; ++i) {
        const bool joins = !rows.empty() && i - rows.back().begin < longest_row &&
                           blocks[i - 1].at.y == blocks[i].at.y && blocks[i - 1].at.z == blocks[i].at.z;
        if (!joins) rows.push_back({i, i});
        rows.back().end = i + 1;
    }
    std::sort(rows.begin(), rows.end(), [&](const BlockRange& a, const BlockRange& b) {
        const glm::i64vec3 &p = blocks[a.begin].at, &q = blocks[b.begin].at;
        return std::tie(p.y, p.z, p.x) < std::tie(q.y, q.z, q.x);
    });
    return rows;
}

// Ids of one batch come before those of the next, because a batch ends where a layer of blocks does.
std::vector<BlockRange> batches_of(const Buffer<LatticeBlock>& blocks) {
    std::vector<BlockRange> batches;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const bool new_layer = i == 0 || blocks[i - 1].at.z != blocks[i].at.z;
        if (batches.empty() || (new_layer && i - batches.back().begin >= batch_blocks))
            batches.push_back({i, i});
        batches.back().end = i + 1;
    }
    return batches;
}

struct Worker {
    std::vector<BlockAnswers> answers;
    std::unique_ptr<BlockScratch> scratch = std::make_unique<BlockScratch>();
    KeptStore corners, centres;
    std::vector<std::size_t> centre_runs{0};  // how many there were before each batch
    std::int64_t zero_alpha = 0;
};

class Generator {
  public:
    Generator(const ClosestPointIndex& index, const Buffer<SurfaceTriangle>& surface, const Lattice& lattice,
              const CullSettings& settings)
        : index_(index), surface_(surface), lattice_(lattice), settings_(settings) {}

    void run(std::span<const LatticeBlock> row, Worker& worker) const {
        worker.answers.resize(longest_row);
        for (std::size_t i = 0; i < row.size(); ++i) {
            query_block(index_, lattice_, settings_, row[i], *worker.scratch, worker.answers[i]);
            for (const std::uint32_t triangle : worker.answers[i].triangle)
                if (triangle != ClosestPoint::none) __builtin_prefetch(&surface_[triangle]);
        }
        store_rows(row, Positions::corners, worker, worker.corners);
        store_rows(row, Positions::centres, worker, worker.centres);
    }

  private:
    void store_rows(std::span<const LatticeBlock> row, Positions kind, Worker& worker,
                    KeptStore& kept) const {
        for (std::int64_t k = 0; k < block_cells; ++k) {
            for (std::int64_t j = 0; j < block_cells; ++j) {
                kept.begin_run();
                store_lattice_row(row, glm::i64vec3(0, j, k), kind, worker, kept);
            }
        }
    }

    // The answers in order of id: one lattice row across all blocks.
    void store_lattice_row(std::span<const LatticeBlock> row, const glm::i64vec3& in_block, Positions kind,
                           Worker& worker, KeptStore& kept) const {
        for (std::size_t b = 0; b < row.size(); ++b) {
            const glm::i64vec3 first = row[b].at * block_cells + in_block;
            const std::uint64_t id =
                kind == Positions::centres ? centre_id(lattice_, first) : corner_id(lattice_, first);
            const BlockAnswers& answers = worker.answers[b];
            for (std::size_t i = 0; i < block_cells; ++i) {
                const std::size_t slot = block_slot(kind, i, static_cast<std::size_t>(in_block.y),
                                                    static_cast<std::size_t>(in_block.z));
                if (answers.triangle[slot] != ClosestPoint::none) store(answers, slot, id + i, worker, kept);
            }
        }
    }

    void store(const BlockAnswers& answers, std::size_t slot, std::uint64_t id, Worker& worker,
               KeptStore& kept) const {
        const SurfaceTriangle& surface = surface_[answers.triangle[slot]];
        const glm::vec2 uv = uv_at(surface, {answers.v[slot], answers.w[slot]});
        const TextureSample picture = sample(*surface.texture, uv, surface.box_texels);
        if (picture.alpha == 0.0f) {
            ++worker.zero_alpha;
            return;
        }
        const glm::vec3 position(glm::dvec3(answers.x[slot], answers.y[slot], answers.z[slot]));
        const auto distance = static_cast<float>(std::sqrt(answers.distance_squared[slot]));
        kept.add({position, picture.color, picture.alpha, distance, id, uv, surface.normal, surface.mesh});
    }

    const ClosestPointIndex& index_;
    const Buffer<SurfaceTriangle>& surface_;
    const Lattice& lattice_;
    const CullSettings& settings_;
};

void append_corners(std::vector<Worker>& workers, SplatSet& set) {
    std::vector<KeptStore::Run> runs;
    for (const Worker& worker : workers)
        runs.insert(runs.end(), worker.corners.runs().begin(), worker.corners.runs().end());
    append_sorted(runs, set);
    for (Worker& worker : workers) worker.corners.clear();
}

void append_centres(std::vector<Worker>& workers, std::size_t batch, SplatSet& set) {
    std::vector<KeptStore::Run> runs;
    for (const Worker& worker : workers) {
        const KeptStore::Run* const all = worker.centres.runs().data();
        runs.insert(runs.end(), all + worker.centre_runs[batch], all + worker.centre_runs[batch + 1]);
    }
    append_sorted(runs, set);
    for (Worker& worker : workers) worker.centres.free_before(worker.centre_runs[batch + 1]);
}

// Batch by batch, so that little is stored twice. Corners and centres of a block are measured together, but
// have the lower and the higher ids: the centres wait until all corners are in the set, and leave their
// blocks of memory as they join it.
std::int64_t run_blocks(const Generator& generator, const Buffer<LatticeBlock>& blocks,
                        const Progress& progress, KeptWatcher* watcher, SplatSet& set) {
    std::vector<Worker> workers(static_cast<std::size_t>(thread_count()));
    const std::vector<BlockRange> batches = batches_of(blocks);
    std::atomic<std::size_t> done{0};
    for (const BlockRange& batch : batches) {
        const std::vector<BlockRange> rows = rows_of(blocks, batch);
        parallel_for(static_cast<std::int64_t>(rows.size()), [&](std::int64_t row, int number) {
            progress.check();
            const BlockRange& range = rows[static_cast<std::size_t>(row)];
            const std::size_t count = range.end - range.begin;
            Worker& worker = workers[static_cast<std::size_t>(number)];
            const std::size_t corner_runs = worker.corners.runs().size();
            const std::size_t centre_runs = worker.centres.runs().size();
            generator.run({&blocks[range.begin], count}, worker);
            if (watcher) {
                watcher->keeps(std::span(worker.corners.runs()).subspan(corner_runs));
                watcher->keeps(std::span(worker.centres.runs()).subspan(centre_runs));
            }
            progress.at(static_cast<double>(done += count) / static_cast<double>(blocks.size()));
        });
        append_corners(workers, set);
        for (Worker& worker : workers) worker.centre_runs.push_back(worker.centres.runs().size());
    }
    for (std::size_t batch = 0; batch < batches.size(); ++batch) {
        progress.check();
        append_centres(workers, batch, set);
    }
    std::int64_t zero_alpha = 0;
    for (const Worker& worker : workers) zero_alpha += worker.zero_alpha;
    return zero_alpha;
}

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
    const double per_splat = 1.02 * static_cast<double>(kept_splat_bytes);  // and a batch that exists twice
    const double per_triangle =
        sizeof(ClusteredTriangle) + sizeof(SurfaceTriangle) + 150.0;  // and Embree's tree
    const double bytes = expected_kept(lattice, meshes, max_distance) * per_splat + triangles * per_triangle;
    return static_cast<std::int64_t>(std::min(bytes, 9e18));
}

SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress, KeptWatcher* watcher) {
    claim_memory(generate_memory_bytes(meshes, lattice, max_distance), "generating splats");
    std::vector<const Mesh*> shapes;
    for (const TexturedMesh& m : meshes) shapes.push_back(&m.mesh);
    const ClosestPointIndex index(shapes);
    const Buffer<SurfaceTriangle> surface = surface_triangles(meshes, index, lattice.spacing());
    const CullSettings settings{max_distance, jitter, seed};
    const NearBlocks near = blocks_near(index, lattice, settings, progress);
    const Buffer<LatticeBlock>& blocks = near.blocks;

    SplatSet set;
    describe_set(meshes, lattice, max_distance, set);
    if (watcher) watcher->begins(set, lattice.box);
    reserve(set, blocks.size() * 2 * block_positions);
    set.zero_alpha = run_blocks(Generator(index, surface, lattice, settings), blocks, progress, watcher, set);
    check_consistent(set);
    return set;
}

}  // namespace astrosplat
