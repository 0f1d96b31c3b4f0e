// Block queries. The block's positions are measured together against the triangles of the clusters that the
// cull found for it, or that are looked for now (block_kernel). Blocks with too many triangles ask Embree for
// each position instead.
#include "generate/block_query.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace astrosplat {
namespace {

// What a kind of positions has along an axis beyond the number of cells.
std::int64_t beyond(Positions kind) { return kind == Positions::corners ? 1 : 0; }

// Coordinates of positions along one axis, before jitter, from cell `first` on.
std::array<double, block_cells> axis_places(const Lattice& lattice, int axis, std::int64_t first,
                                            Positions kind) {
    const double offset = kind == Positions::centres ? 0.5 : 0.0;
    std::array<double, block_cells> at;
    for (std::int64_t i = 0; i < block_cells; ++i)
        at[static_cast<std::size_t>(i)] =
            lattice_coordinate(lattice, axis, static_cast<double>(first + i) + offset);
    return at;
}

KindPlaces kind_places(const Lattice& lattice, const glm::i64vec3& first, Positions kind) {
    const glm::i64vec3 count = lattice.n + beyond(kind);
    return {axis_places(lattice, 0, first.x, kind),
            axis_places(lattice, 1, first.y, kind),
            axis_places(lattice, 2, first.z, kind),
            kind == Positions::centres ? centre_id(lattice, first) : corner_id(lattice, first),
            static_cast<std::uint64_t>(count.x),
            static_cast<std::uint64_t>(count.x * count.y)};
}

// Places beyond the lattice's end were measured with the rest.
void drop_outside(const Lattice& lattice, const glm::i64vec3& first, Positions kind, BlockAnswers& answers) {
    const glm::i64vec3 inside = glm::clamp(lattice.n + beyond(kind) - first, std::int64_t{0}, block_cells);
    if (inside == glm::i64vec3(block_cells)) return;
    for (std::int64_t k = 0; k < block_cells; ++k)
        for (std::int64_t j = 0; j < block_cells; ++j)
            for (std::int64_t i = 0; i < block_cells; ++i)
                if (i >= inside.x || j >= inside.y || k >= inside.z)
                    answers.triangle[block_slot(kind, static_cast<std::size_t>(i),
                                                static_cast<std::size_t>(j), static_cast<std::size_t>(k))] =
                        ClosestPoint::none;
}

// Clusters with all triangles that may be closest to a position of the block; there may be none.
std::span<const std::uint32_t> clusters_of(const ClosestPointIndex& index, const CullSettings& settings,
                                           const LatticeBlock& block, const BlockBall& ball,
                                           std::vector<std::uint32_t>& found) {
    if (block.cluster_count > 0) return {block.clusters, block.cluster_count};
    index.collect(ball.center, candidate_radius(settings, ball, block.distance), found);
    return found;
}

void ask_embree(const ClosestPointIndex& index, double max_distance, std::uint32_t hint,
                BlockAnswers& answers) {
    for (std::size_t s = 0; s < block_positions; ++s) {
        const ClosestPoint found =
            index.closest({answers.x[s], answers.y[s], answers.z[s]}, max_distance, hint);
        answers.distance_squared[s] = found.distance_squared;
        answers.triangle[s] = found.triangle;
        answers.v[s] = found.barycentric.x;
        answers.w[s] = found.barycentric.y;
        if (found.triangle != ClosestPoint::none) hint = found.triangle;
    }
}

}  // namespace

void query_block(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, BlockScratch& scratch, BlockAnswers& answers) {
    const glm::i64vec3 first = block.at * block_cells;
    place_block(
        {kind_places(lattice, first, Positions::corners), kind_places(lattice, first, Positions::centres),
         lattice.spacing() * (0.5 * settings.jitter), settings.seed},
        answers);

    const BlockBall ball = block_ball(lattice, settings.jitter, first, block_cells);
    const std::span<const std::uint32_t> clusters =
        clusters_of(index, settings, block, ball, scratch.clusters);
    if (clusters.empty()) {
        answers.triangle.fill(ClosestPoint::none);
        return;
    }
    const auto slack = static_cast<float>(index.slack(ball.center, 2.0 * ball.radius));
    const BlockMeasure measure{index.triangles(), index.clusters(), index.origin(), slack,
                               settings.max_distance};
    if (!measure_block(measure, {clusters, block.near_slot}, scratch, answers))
        ask_embree(index, settings.max_distance, index.triangles()[block.near_slot].number, answers);
    drop_outside(lattice, first, Positions::corners, answers);
    drop_outside(lattice, first, Positions::centres, answers);
}

}  // namespace astrosplat
