// Block queries. All triangles that can be closest to some position of the block are collected once, with
// boxes, and each position measures those whose boxes are nearer than what it has. A search starts from the
// answer of the position before, which is almost always close. Blocks with too many triangles ask Embree for
// each position instead.
#include "splats/block_query.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace astrosplat {
namespace {

class BlockQuery {
  public:
    BlockQuery(const ClosestPointIndex& index, double max_distance, const LatticeBlock& block,
               const BlockBall& ball, BlockScratch& scratch)
        : index_(index), max_distance_(max_distance), scratch_(scratch), hint_(block.nearest) {
        // A triangle that is closest to a position p of the ball is no farther from its middle than |p -
        // middle| + distance(p), and distance(p) is at most both max_distance and distance(middle) + |p -
        // middle|.
        const double radius = ball.radius + std::min(max_distance, block.distance + ball.radius);
        listed_ = index.collect(ball.center, radius * (1.0 + 1e-9), scratch.candidates);
    }

    ClosestPoint closest(const glm::dvec3& p) {
        const ClosestPoint found = listed_ ? closest_listed(p) : index_.closest(p, max_distance_, hint_);
        if (found.triangle != ClosestPoint::none) hint_ = found.triangle;
        return found;
    }

  private:
    ClosestPoint closest_listed(const glm::dvec3& p) {
        ClosestPoint best{max_distance_ * max_distance_, ClosestPoint::none, {}};
        offer(hint_, p, best);
        NearBoxes& found = scratch_.near_boxes;
        float limit = index_.box_limit(p, std::sqrt(best.distance_squared));
        find_near_boxes(scratch_.candidates, index_.local(p), limit, found);
        if (found.count == 0) return best;
        const float* nearest = std::min_element(found.squared.data(), found.squared.data() + found.count);
        if (offer(number(static_cast<std::size_t>(nearest - found.squared.data())), p, best)) {
            limit = index_.box_limit(p, std::sqrt(best.distance_squared));
        }
        for (std::size_t i = 0; i < found.count; ++i) {
            if (found.squared[i] > limit || number(i) == best.triangle) continue;
            if (offer(number(i), p, best)) limit = index_.box_limit(p, std::sqrt(best.distance_squared));
        }
        return best;
    }

    std::uint32_t number(std::size_t found) const {
        return scratch_.candidates.triangle[scratch_.near_boxes.place[found]];
    }

    bool offer(std::uint32_t triangle, const glm::dvec3& p, ClosestPoint& best) const {
        const ClosestPoint other = index_.closest_of(triangle, p);
        const bool better = nearer(other, best);
        if (better) best = other;
        return better;
    }

    const ClosestPointIndex& index_;
    const double max_distance_;
    BlockScratch& scratch_;
    bool listed_;         // else there are too many triangles: ask Embree
    std::uint32_t hint_;  // a triangle that is probably close
};

// Coordinates of a block's positions along one axis, before jitter.
struct AxisPlaces {
    std::array<double, block_cells> at;
    std::size_t count;  // of them inside the lattice
};

AxisPlaces places(const Lattice& lattice, int axis, std::int64_t first, Positions kind) {
    const bool centres = kind == Positions::centres;
    AxisPlaces p;
    const std::int64_t end = lattice.n[axis] + (centres ? 0 : 1);
    p.count = static_cast<std::size_t>(std::clamp(end - first, std::int64_t{0}, block_cells));
    for (std::size_t i = 0; i < p.count; ++i) {
        const double cells =
            static_cast<double>(first + static_cast<std::int64_t>(i)) + (centres ? 0.5 : 0.0);
        p.at[i] = lattice_coordinate(lattice, axis, cells);
    }
    return p;
}

}  // namespace

void query_block(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, Positions kind, BlockScratch& scratch, BlockAnswers& answers) {
    for (FoundPoint& found : answers) found.closest.triangle = ClosestPoint::none;
    const glm::i64vec3 first = block.at * block_cells;
    const BlockBall ball = block_ball(lattice, settings.jitter, first, block_cells);
    BlockQuery query(index, settings.max_distance, block, ball, scratch);
    const glm::dvec3 half_range = lattice.spacing() * (0.5 * settings.jitter);
    const AxisPlaces x = places(lattice, 0, first.x, kind), y = places(lattice, 1, first.y, kind),
                     z = places(lattice, 2, first.z, kind);
    for (std::size_t k = 0; k < z.count; ++k) {
        for (std::size_t j = 0; j < y.count; ++j) {
            const glm::i64vec3 row = first + glm::i64vec3(0, j, k);
            const std::uint64_t id =
                kind == Positions::centres ? centre_id(lattice, row) : corner_id(lattice, row);
            for (std::size_t i = 0; i < x.count; ++i) {
                const glm::dvec3 p =  // the same sum as in jittered_position
                    glm::dvec3(x.at[i], y.at[j], z.at[k]) + jitter_offset(id + i, settings.seed, half_range);
                answers[(k * block_cells + j) * block_cells + i] = {query.closest(p), glm::vec3(p)};
            }
        }
    }
}

}  // namespace astrosplat
