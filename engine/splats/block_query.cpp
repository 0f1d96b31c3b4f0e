// Block queries. All triangles that can be closest to some position of the block are collected once, with
// boxes; each group of 2 x 2 x 2 cells takes those that can matter to it, and each position measures those
// whose boxes are nearer than what it has. A search starts from the answer of the position before, which is
// almost always close. Blocks with too many triangles ask Embree for each position instead.
#include "splats/block_query.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace astrosplat {
namespace {

constexpr std::int64_t group_cells = 2;

float limit_of(double distance, double slack) {
    const double widened = distance * 1.00001 + slack;
    return static_cast<float>(widened * widened * 1.00001);
}

// A triangle that is closest to a position p of the ball is no farther from its middle than |p - middle| +
// distance(p), and distance(p) is at most both max_distance and distance(middle) + |p - middle|.
double candidate_radius(const BlockBall& ball, double distance, double max_distance) {
    return (ball.radius + std::min(max_distance, distance + ball.radius)) * (1.0 + 1e-9);
}

class BlockQuery {
  public:
    BlockQuery(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
               const LatticeBlock& block, BlockScratch& scratch)
        : index_(index),
          lattice_(lattice),
          settings_(settings),
          scratch_(scratch),
          half_range_(lattice.spacing() * (0.5 * settings.jitter)),
          hint_(block.nearest) {
        const BlockBall ball = block_ball(lattice, settings.jitter, block.at * block_cells, block_cells);
        collect(ball, candidate_radius(ball, block.distance, settings.max_distance));
    }

    void run_group(const glm::i64vec3& first, const glm::i64vec3& block_first, Positions kind,
                   BlockAnswers& answers) {
        if (listed_ && !collect_group(block_ball(lattice_, settings_.jitter, first, group_cells))) return;
        const std::int64_t more = kind == Positions::corners ? 1 : 0;
        const glm::i64vec3 end = glm::min(first + group_cells, lattice_.n + more);
        for (std::int64_t k = first.z; k < end.z; ++k) {
            for (std::int64_t j = first.y; j < end.y; ++j) {
                for (std::int64_t i = first.x; i < end.x; ++i) {
                    const glm::i64vec3 in_block = glm::i64vec3(i, j, k) - block_first;
                    const auto place = (in_block.z * block_cells + in_block.y) * block_cells + in_block.x;
                    answers[static_cast<std::size_t>(place)] = answer(position({i, j, k}, kind));
                }
            }
        }
    }

  private:
    // The same sums as in jittered_position.
    glm::dvec3 position(const glm::i64vec3& at, Positions kind) const {
        const bool centre = kind == Positions::centres;
        const glm::dvec3 cells = glm::dvec3(at) + (centre ? 0.5 : 0.0);
        const std::uint64_t id = centre ? centre_id(lattice_, at) : corner_id(lattice_, at);
        return glm::dvec3(lattice_coordinate(lattice_, 0, cells.x), lattice_coordinate(lattice_, 1, cells.y),
                          lattice_coordinate(lattice_, 2, cells.z)) +
               jitter_offset(id, settings_.seed, half_range_);
    }

    // Boxes are relative to the block's middle and cut to where they can matter, so that float suffices.
    void collect(const BlockBall& ball, double radius) {
        const std::size_t count = index_.within(ball.center, radius, scratch_.triangles);
        listed_ = count <= BoxList::most;
        if (!listed_) return;
        middle_ = ball.center;
        slack_ = 1e-6 * (radius + ball.radius);
        const glm::dvec3 window(2.0 * ball.radius);
        scratch_.block.count = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const TriangleShape& s = index_.shape(scratch_.triangles[i]);
            const glm::dvec3 a = s.a - middle_, b = a + s.ab, c = a + s.ac;
            scratch_.block.add(scratch_.triangles[i],
                               glm::vec3(glm::max(glm::min(glm::min(a, b), c), -window)),
                               glm::vec3(glm::min(glm::max(glm::max(a, b), c), window)));
        }
    }

    // False when the whole group is too far away.
    bool collect_group(const BlockBall& ball) {
        const ClosestPoint closest =
            closest_listed(scratch_.block, ball.center, settings_.max_distance + ball.radius);
        if (closest.triangle == ClosestPoint::none) return false;
        hint_ = closest.triangle;
        const double radius =
            candidate_radius(ball, std::sqrt(closest.distance_squared), settings_.max_distance);
        NearBoxes& found = scratch_.near_boxes;
        find_near_boxes(scratch_.block, glm::vec3(ball.center - middle_), limit_of(radius, slack_), found);
        scratch_.cell_group.count = 0;
        for (std::size_t i = 0; i < found.count; ++i) scratch_.cell_group.add(scratch_.block, found.place[i]);
        return true;
    }

    FoundPoint answer(const glm::dvec3& p) {
        const ClosestPoint closest = listed_ ? closest_listed(scratch_.cell_group, p, settings_.max_distance)
                                             : index_.closest(p, settings_.max_distance, hint_);
        if (closest.triangle != ClosestPoint::none) hint_ = closest.triangle;
        return {closest, glm::vec3(p)};
    }

    ClosestPoint closest_listed(const BoxList& boxes, const glm::dvec3& p, double max_distance) {
        ClosestPoint best{max_distance * max_distance, ClosestPoint::none, {}};
        const ClosestPoint hinted = index_.closest_of(hint_, p);
        if (nearer(hinted, best)) best = hinted;
        NearBoxes& found = scratch_.near_boxes;
        float limit = limit_of(std::sqrt(best.distance_squared), slack_);
        find_near_boxes(boxes, glm::vec3(p - middle_), limit, found);
        for (std::size_t i = 0; i < found.count; ++i) {
            const std::uint32_t triangle = boxes.triangle[found.place[i]];
            if (found.squared[i] > limit || triangle == hint_) continue;
            const ClosestPoint other = index_.closest_of(triangle, p);
            if (!nearer(other, best)) continue;
            best = other;
            limit = limit_of(std::sqrt(best.distance_squared), slack_);
        }
        return best;
    }

    const ClosestPointIndex& index_;
    const Lattice& lattice_;
    const CullSettings& settings_;
    BlockScratch& scratch_;
    glm::dvec3 half_range_;  // of the jitter, scene units
    glm::dvec3 middle_{0.0};
    double slack_ = 0.0;   // scene units; more than the rounding of boxes and of query points
    bool listed_ = false;  // else there are too many triangles: ask Embree
    std::uint32_t hint_;   // a triangle that is probably close
};

}  // namespace

void query_block(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, Positions kind, BlockScratch& scratch, BlockAnswers& answers) {
    for (FoundPoint& found : answers) found.closest.triangle = ClosestPoint::none;
    BlockQuery query(index, lattice, settings, block, scratch);
    const glm::i64vec3 first = block.at * block_cells;
    for (std::int64_t z = 0; z < block_cells; z += group_cells) {
        for (std::int64_t y = 0; y < block_cells; y += group_cells) {
            for (std::int64_t x = 0; x < block_cells; x += group_cells) {
                const glm::i64vec3 group = first + glm::i64vec3(x, y, z);
                const bool inside =
                    group.x <= lattice.n.x && group.y <= lattice.n.y && group.z <= lattice.n.z;
                if (inside) query.run_group(group, first, kind, answers);
            }
        }
    }
}

}  // namespace astrosplat
