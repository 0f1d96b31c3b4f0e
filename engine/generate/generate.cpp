// Generation: blocks of the lattice near the meshes, the closest point of each of their positions, its
// colour; then everything in order of id. Threads take short rows of blocks; what they write depends on the
// row alone.
#include "generate/generate.h"

#include <algorithm>
#include <atomic>
#include <string>
#include <tuple>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"
#include "generate/block_cull.h"
#include "generate/block_sampler.h"
#include "generate/closest_point.h"
#include "generate/kept_watcher.h"
#include "generate/surface.h"

namespace astrosplat {
namespace {

constexpr std::size_t batch_blocks = 1u << 13;  // about this many are kept apart before they join the set

/// Blocks begin .. end-1: a row has the same (y, z) and ascending x, a batch is whole layers of the same z.
struct BlockRange {
    std::size_t begin, end;
};

// Rows that lie above each other follow each other: they need much the same triangles.
std::vector<BlockRange> rows_of(const Buffer<LatticeBlock>& blocks, const BlockRange& batch) {
    std::vector<BlockRange> rows;
    for (std::size_t i = batch.begin; i < batch.end; ++i) {
        const bool joins = !rows.empty() && i - rows.back().begin < BlockSampler::longest_row &&
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

struct Worker : SamplerWorker {
    std::vector<std::size_t> centre_runs{0};  // how many there were before each batch
};

// Corners and centres of a block are measured together, but the corners have all the lower ids: the centres'
// hits wait until the corners are in the set, and are freed as they join it. All goes batch by batch, so that
// little is stored twice.
class BlockRun {
  public:
    BlockRun(const BlockSampler& sampler, const Buffer<LatticeBlock>& blocks, const Progress& progress,
             KeptWatcher* watcher)
        : sampler_(sampler),
          blocks_(blocks),
          progress_(progress),
          watcher_(watcher),
          workers_(static_cast<std::size_t>(thread_count())) {}

    void run(SplatSet& set) {
        const std::vector<BlockRange> batches = batches_of(blocks_);
        for (const BlockRange& batch : batches) {
            measure(batch);
            append_kept(set);
        }
        for (std::size_t batch = 0; batch < batches.size(); ++batch) {
            keep_centres(batch);
            append_kept(set);
            progress_.at(measuring + (1.0 - measuring) * static_cast<double>(batch + 1) /
                                         static_cast<double>(batches.size()));
        }
        for (const Worker& worker : workers_) set.zero_alpha += worker.zero_alpha;
    }

  private:
    static constexpr double measuring = 0.8;  // of the time

    void measure(const BlockRange& batch) {
        const std::vector<BlockRange> rows = rows_of(blocks_, batch);
        parallel_for(static_cast<std::int64_t>(rows.size()), [&](std::int64_t row, int number) {
            progress_.check();
            const BlockRange& range = rows[static_cast<std::size_t>(row)];
            const std::size_t count = range.end - range.begin;
            watched(number, [&](SamplerWorker& worker) {
                sampler_.measure({&blocks_[range.begin], count}, worker);
            });
            progress_.at(measuring * static_cast<double>(done_ += count) /
                         static_cast<double>(blocks_.size()));
        });
        for (Worker& worker : workers_) worker.centre_runs.push_back(worker.centres.runs().size());
    }

    void keep_centres(std::size_t batch) {
        std::vector<HitStore::Run> runs;
        for (const Worker& worker : workers_) {
            const HitStore::Run* const all = worker.centres.runs().data();
            runs.insert(runs.end(), all + worker.centre_runs[batch], all + worker.centre_runs[batch + 1]);
        }
        parallel_chunks(static_cast<std::int64_t>(runs.size()), 128,
                        [&](std::int64_t begin, std::int64_t end, int number) {
                            progress_.check();
                            const std::span part(runs.data() + begin, runs.data() + end);
                            watched(number, [&](SamplerWorker& worker) { sampler_.keep(part, worker); });
                        });
        for (Worker& worker : workers_) worker.centres.free_before(worker.centre_runs[batch + 1]);
    }

    // Shows what the worker's task keeps.
    template <class Task>
    void watched(int number, const Task& task) {
        Worker& worker = workers_[static_cast<std::size_t>(number)];
        const std::size_t runs = worker.kept.runs().size();
        task(worker);
        if (watcher_) watcher_->keeps(std::span(worker.kept.runs()).subspan(runs));
    }

    void append_kept(SplatSet& set) {
        std::vector<KeptStore::Run> runs;
        for (const Worker& worker : workers_)
            runs.insert(runs.end(), worker.kept.runs().begin(), worker.kept.runs().end());
        append_sorted(runs, set);
        for (Worker& worker : workers_) worker.kept.clear();
    }

    const BlockSampler& sampler_;
    const Buffer<LatticeBlock>& blocks_;
    const Progress& progress_;
    KeptWatcher* watcher_;
    std::vector<Worker> workers_;
    std::atomic<std::size_t> done_{0};  // blocks
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
        1.02 * static_cast<double>(bytes_per_splat(is_generated));  // and a batch that exists twice
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
    reserve(set, blocks.size() * block_positions);
    const BlockSampler sampler(index, surface, lattice, settings);
    BlockRun(sampler, blocks, progress, watcher).run(set);
    check_consistent(set);
    return set;
}

}  // namespace astrosplat
