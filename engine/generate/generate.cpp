// Generation: blocks of the lattice near the meshes, the closest point of each of their positions, its
// colour; then everything in order of id. Threads take short rows of blocks; what they write depends on the
// row alone.
#include "generate/generate.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"
#include "generate/block_query.h"
#include "generate/columns.h"
#include "generate/kept_store.h"
#include "generate/surface.h"
#include "source/sample.h"

namespace astrosplat {
namespace {

constexpr std::size_t longest_row = 64;         // blocks: their answers stay in the second-level cache
constexpr std::size_t batch_blocks = 1u << 13;  // about this many are kept apart before they join the set

/// Blocks begin .. end-1: a row has the same (y, z) and ascending x, a batch is whole layers of the same z.
struct BlockRange {
    std::size_t begin, end;
};

std::vector<BlockRange> rows_of(const std::vector<LatticeBlock>& blocks, const BlockRange& batch) {
    std::vector<BlockRange> rows;
    for (std::size_t i = batch.begin; i < batch.end; ++i) {
        const bool joins = !rows.empty() && i - rows.back().begin < longest_row &&
                           blocks[i - 1].at.y == blocks[i].at.y && blocks[i - 1].at.z == blocks[i].at.z;
        if (!joins) rows.push_back({i, i});
        rows.back().end = i + 1;
    }
    return rows;
}

// Ids of one batch come before those of the next, because a batch ends where a layer of blocks does.
std::vector<BlockRange> batches_of(const std::vector<LatticeBlock>& blocks) {
    std::vector<BlockRange> batches;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const bool new_layer = i == 0 || blocks[i - 1].at.z != blocks[i].at.z;
        if (batches.empty() || (new_layer && i - batches.back().begin >= batch_blocks))
            batches.push_back({i, i});
        batches.back().end = i + 1;
    }
    return batches;
}

/// What one thread works with and what it finds.
struct Worker {
    std::vector<BlockAnswers> answers;
    std::vector<std::uint32_t> scratch;
    KeptStore kept;
    std::int64_t unseen = 0;  // positions that no picture shows, whatever it is
};

// All corners, then all centres, as their ids ask for; each time batch by batch, so that little is stored
// twice.
class BlockRun {
  public:
    BlockRun(const TriangleTree& tree, const Buffer<SurfaceTriangle>& surface, const Lattice& lattice,
             const CullSettings& settings, const Progress& progress, KeptWatcher* watcher)
        : tree_(tree),
          surface_(surface),
          lattice_(lattice),
          settings_(settings),
          progress_(progress),
          watcher_(watcher),
          workers_(static_cast<std::size_t>(thread_count())) {}

    void run(const std::vector<LatticeBlock>& blocks, SplatSet& set) {
        const std::vector<BlockRange> batches = batches_of(blocks);
        for (const Positions kind : {Positions::corners, Positions::centres}) {
            for (const BlockRange& batch : batches) {
                run_batch(blocks, batch, kind);
                append_kept(set);
            }
        }
        for (const Worker& worker : workers_) set.zero_alpha += worker.unseen;
    }

  private:
    void run_batch(const std::vector<LatticeBlock>& blocks, const BlockRange& batch, Positions kind) {
        const std::vector<BlockRange> rows = rows_of(blocks, batch);
        parallel_for(static_cast<std::int64_t>(rows.size()), [&](std::int64_t row, int number) {
            progress_.check();
            const BlockRange& range = rows[row];
            const std::size_t count = range.end - range.begin;
            Worker& worker = workers_[number];
            const std::size_t runs = worker.kept.runs().size();
            run_row({&blocks[range.begin], count}, kind, worker);
            if (watcher_) watcher_->keeps(std::span(worker.kept.runs()).subspan(runs));
            progress_.at(0.5 * static_cast<double>(done_ += count) / static_cast<double>(blocks.size()));
        });
    }

    // The answers in order of id: each lattice row across all blocks, which is a run of the store.
    void run_row(std::span<const LatticeBlock> row, Positions kind, Worker& worker) const {
        worker.answers.resize(longest_row);
        for (std::size_t i = 0; i < row.size(); ++i) {
            query_block(tree_, lattice_, settings_, row[i], kind, worker.scratch, worker.answers[i]);
        }
        for (std::size_t k = 0; k < block_cells; ++k) {
            for (std::size_t j = 0; j < block_cells; ++j) {
                worker.kept.begin_run();
                for (std::size_t b = 0; b < row.size(); ++b)
                    keep_row_of_block(row[b], kind, j, k, worker.answers[b], worker);
            }
        }
    }

    void keep_row_of_block(const LatticeBlock& block, Positions kind, std::size_t j, std::size_t k,
                           const BlockAnswers& answers, Worker& worker) const {
        const glm::i64vec3 at = block.at * block_cells + glm::i64vec3(0, j, k);
        const std::uint64_t id =
            kind == Positions::centres ? centre_id(lattice_, at) : corner_id(lattice_, at);
        for (std::size_t i = 0; i < block_cells; ++i) {
            const std::size_t slot = block_slot(i, j, k);
            if (answers.triangle[slot] != ClosestPoint::none) keep(answers, slot, id + i, worker);
        }
    }

    void keep(const BlockAnswers& answers, std::size_t slot, std::uint64_t id, Worker& worker) const {
        const SurfaceTriangle& surface = surface_[answers.triangle[slot]];
        const glm::dvec3 place(answers.x[slot], answers.y[slot], answers.z[slot]);
        const std::optional<glm::vec2> uv = uv_of(surface, {answers.v[slot], answers.w[slot]}, place);
        if (!uv) {
            ++worker.unseen;
            return;
        }
        const TextureSample picture = sample(*surface.texture, *uv, surface.box_texels);
        const glm::vec3 position(place);
        const auto distance = static_cast<float>(std::sqrt(answers.distance_squared[slot]));
        worker.kept.add({position, picture.color, picture.alpha, distance, id, *uv, surface.normal,
                         surface.mesh, answers.triangle[slot]});
    }

    void append_kept(SplatSet& set) {
        std::vector<KeptStore::Run> runs;
        for (const Worker& worker : workers_)
            runs.insert(runs.end(), worker.kept.runs().begin(), worker.kept.runs().end());
        append_sorted(runs, set);
        for (Worker& worker : workers_) worker.kept.clear();
    }

    const TriangleTree& tree_;
    const Buffer<SurfaceTriangle>& surface_;
    const Lattice& lattice_;
    const CullSettings& settings_;
    const Progress& progress_;
    KeptWatcher* watcher_;
    std::vector<Worker> workers_;
    std::atomic<std::size_t> done_{0};  // blocks, each once for either kind
};

// Adds what is kept to the set.
void run_cull(std::span<const TexturedMesh> meshes, const Lattice& lattice, const CullSettings& settings,
              const Progress& progress, KeptWatcher* watcher, SplatSet& set) {
    std::vector<const Mesh*> shapes;
    for (const TexturedMesh& m : meshes) shapes.push_back(&m.mesh);
    const TriangleTree tree = make_triangle_tree(shapes);
    const Buffer<SurfaceTriangle> surface = surface_triangles(meshes, lattice.spacing());
    const std::vector<LatticeBlock> blocks = blocks_near(tree, lattice, settings, progress);
    reserve(set, blocks.size() * 2 * block_positions);
    BlockRun(tree, surface, lattice, settings, progress, watcher).run(blocks, set);
}

void describe_set(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  SplatSet& set) {
    set.spacing = lattice.spacing();
    set.max_distance = max_distance;
    set.generated = true;
    set.test_positions = lattice.positions();
    describe_pictures(meshes, set);
}

}  // namespace

namespace {

/// What so many positions take, and a batch of them that exists twice.
double bytes_of_positions(double positions) {
    constexpr double most_in_batch = 0.5 * batch_blocks * block_positions;  // a surface keeps half of a block
    return positions * static_cast<double>(bytes_per_splat(is_generated)) +
           std::min(0.5 * positions, most_in_batch) * static_cast<double>(sizeof(KeptSplat));
}

}  // namespace

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
    SplatSet set;
    run_cull(meshes, lattice, {max_distance, 1.0, 1}, {}, nullptr, set);
    return {set.size() + set.zero_alpha, std::ranges::count_if(set.alpha, [](float a) { return a > 0.0f; })};
}

Columns make_columns(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                     double jitter, std::uint32_t seed, const Progress& progress, KeptWatcher* watcher) {
    claim_memory(columns_memory_bytes(meshes, lattice, max_distance), "generating splats");
    Columns columns;
    describe_set(meshes, lattice, max_distance, columns.splats);
    if (watcher) watcher->begins(columns.splats, lattice.box);
    run_cull(meshes, lattice, {max_distance, jitter, seed}, progress, watcher, columns.splats);
    check_consistent(columns.splats);
    if (watcher) show_end(columns, *watcher);
    return columns;
}

SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress) {
    return lit_splats(make_columns(meshes, lattice, max_distance, jitter, seed, progress));
}

}  // namespace astrosplat
