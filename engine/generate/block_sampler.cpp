#include "generate/block_sampler.h"

#include <cmath>

#include "generate/block_query.h"

namespace astrosplat {

void BlockSampler::measure(std::span<const LatticeBlock> row, SamplerWorker& worker) const {
    worker.answers.resize(longest_row);
    for (std::size_t i = 0; i < row.size(); ++i) {
        query_block(index_, lattice_, settings_, row[i], *worker.scratch, worker.answers[i]);
        for (const std::uint32_t triangle : worker.answers[i].triangle)
            if (triangle != ClosestPoint::none) __builtin_prefetch(&surface_[triangle]);
    }
    each_hit(row, Positions::corners, worker.answers, worker.kept,
             [&](const Hit& hit) { add_splat(hit, worker); });
    each_hit(row, Positions::centres, worker.answers, worker.centres,
             [&](const Hit& hit) { worker.centres.add(hit); });
}

void BlockSampler::keep(std::span<const HitStore::Run> runs, SamplerWorker& worker) const {
    for (std::size_t r = 0; r < runs.size(); ++r) {
        if (r + 1 < runs.size())  // triangles are fetched one run ahead
            for (std::size_t i = 0; i < runs[r + 1].count; ++i)
                __builtin_prefetch(&surface_[runs[r + 1].splats[i].triangle]);
        worker.kept.begin_run();
        for (std::size_t i = 0; i < runs[r].count; ++i) add_splat(runs[r].splats[i], worker);
    }
}

// Visits the answers in order of id, each lattice row across all blocks, which is a run of the store.
template <class Store, class Visit>
void BlockSampler::each_hit(std::span<const LatticeBlock> row, Positions kind,
                            std::span<const BlockAnswers> answers, Store& store, const Visit& visit) const {
    for (std::size_t k = 0; k < block_cells; ++k) {
        for (std::size_t j = 0; j < block_cells; ++j) {
            store.begin_run();
            for (std::size_t b = 0; b < row.size(); ++b)
                each_hit_of_block(row[b].at * block_cells, kind, j, k, answers[b], visit);
        }
    }
}

template <class Visit>
void BlockSampler::each_hit_of_block(const glm::i64vec3& first, Positions kind, std::size_t j, std::size_t k,
                                     const BlockAnswers& answers, const Visit& visit) const {
    const glm::i64vec3 at = first + glm::i64vec3(0, j, k);
    const std::uint64_t id = kind == Positions::centres ? centre_id(lattice_, at) : corner_id(lattice_, at);
    for (std::size_t i = 0; i < block_cells; ++i) {
        const std::size_t slot = block_slot(kind, i, j, k);
        if (answers.triangle[slot] != ClosestPoint::none) visit(hit_of(answers, slot, id + i));
    }
}

Hit BlockSampler::hit_of(const BlockAnswers& answers, std::size_t slot, std::uint64_t id) const {
    const std::uint32_t triangle = answers.triangle[slot];
    return {id, glm::vec3(glm::dvec3(answers.x[slot], answers.y[slot], answers.z[slot])),
            static_cast<float>(std::sqrt(answers.distance_squared[slot])),
            uv_at(surface_[triangle], {answers.v[slot], answers.w[slot]}), triangle};
}

void BlockSampler::add_splat(const Hit& hit, SamplerWorker& worker) const {
    const SurfaceTriangle& surface = surface_[hit.triangle];
    const TextureSample picture = sample(*surface.texture, hit.uv, surface.box_texels);
    if (picture.alpha == 0.0f) {
        ++worker.zero_alpha;
        return;
    }
    worker.kept.add({hit.position, picture.color, picture.alpha, hit.distance, hit.id, hit.uv, surface.normal,
                     surface.mesh});
}

}  // namespace astrosplat
