// Block queries. All triangles that can be closest to some position of the block are collected once; when
// they are few, each position looks only at those, nearest boxes first. Otherwise Embree is asked for each
// position. Either way a search starts from the answer of the position before, which is almost always close.
#include "splats/block_query.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace astrosplat {
namespace {

constexpr std::size_t most_candidates = 64;

// The triangles of one block: numbers, and float boxes around them for a bound that a vector unit can
// compute. The boxes are relative to the block's middle and cut to where they can matter, so that float
// suffices.
struct Candidates {
    std::size_t count = 0;  // most_candidates + 1: too many, ask Embree
    std::array<std::uint32_t, most_candidates> triangle;
    std::array<float, most_candidates> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
    glm::dvec3 middle;
    double slack;  // scene units; more than the rounding of boxes and of query points
};

Candidates collect(const ClosestPointIndex& index, const BlockBall& ball, const LatticeBlock& block,
                   double max_distance) {
    Candidates c;
    c.middle = ball.center;
    // A triangle that is closest to a position p is no farther from the middle than |p - middle| +
    // distance(p), and distance(p) is at most both max_distance and distance(middle) + |p - middle|.
    const double radius = ball.radius + std::min(max_distance, block.distance + ball.radius);
    c.count = index.within(ball.center, radius * (1.0 + 1e-9), c.triangle);
    if (c.count > most_candidates) return c;
    c.slack = 1e-6 * (radius + ball.radius);
    const glm::dvec3 window(2.0 * ball.radius);
    for (std::size_t i = 0; i < c.count; ++i) {
        const TriangleShape& s = index.shape(c.triangle[i]);
        const glm::dvec3 a = s.a - ball.center, b = a + s.ab, d = a + s.ac;
        const glm::vec3 lo(glm::max(glm::min(glm::min(a, b), d), -window));
        const glm::vec3 hi(glm::min(glm::max(glm::max(a, b), d), window));
        c.lo_x[i] = lo.x, c.lo_y[i] = lo.y, c.lo_z[i] = lo.z;
        c.hi_x[i] = hi.x, c.hi_y[i] = hi.y, c.hi_z[i] = hi.z;
    }
    return c;
}

// Squared distances from p to the candidates' boxes; the loop is plain so that the compiler vectorises it.
void box_distances(const Candidates& c, const glm::vec3& p, std::array<float, most_candidates>& squared) {
    for (std::size_t i = 0; i < c.count; ++i) {
        const float x = std::max(std::max(c.lo_x[i] - p.x, p.x - c.hi_x[i]), 0.0f);
        const float y = std::max(std::max(c.lo_y[i] - p.y, p.y - c.hi_y[i]), 0.0f);
        const float z = std::max(std::max(c.lo_z[i] - p.z, p.z - c.hi_z[i]), 0.0f);
        squared[i] = x * x + y * y + z * z;
    }
}

// A box farther away than this cannot hold anything nearer than `best`.
float box_limit(const Candidates& c, const ClosestPoint& best) {
    const double distance = std::sqrt(best.distance_squared) * 1.00001 + c.slack;
    return static_cast<float>(distance * distance * 1.00001);
}

ClosestPoint closest_candidate(const ClosestPointIndex& index, const Candidates& c, const glm::dvec3& p,
                               double max_distance, std::uint32_t hint) {
    ClosestPoint best{max_distance * max_distance, ClosestPoint::none, {}};
    const auto offer = [&](std::uint32_t triangle) {
        const ClosestPoint other = index.closest_of(triangle, p);
        const bool better = nearer(other, best);
        if (better) best = other;
        return better;
    };
    offer(hint);
    std::array<float, most_candidates> squared;
    box_distances(c, glm::vec3(p - c.middle), squared);
    float limit = box_limit(c, best);
    for (std::size_t i = 0; i < c.count; ++i) {
        if (squared[i] > limit || c.triangle[i] == hint) continue;
        if (offer(c.triangle[i])) limit = box_limit(c, best);
    }
    return best;
}

struct AxisPlaces {
    std::array<double, block_cells> at;  // coordinates before jitter
    std::int64_t count;                  // of them inside the lattice
};

AxisPlaces places(const Lattice& lattice, int axis, std::int64_t first, bool centres) {
    AxisPlaces p;
    const std::int64_t end = lattice.n[axis] + (centres ? 0 : 1);
    p.count = std::clamp(end - first, std::int64_t{0}, block_cells);
    for (std::int64_t i = 0; i < p.count; ++i) {
        const double cells = static_cast<double>(first + i) + (centres ? 0.5 : 0.0);
        p.at[static_cast<std::size_t>(i)] = lattice_coordinate(lattice, axis, cells);
    }
    return p;
}

struct BlockQuery {
    const ClosestPointIndex& index;
    const Lattice& lattice;
    const CullSettings& settings;
    glm::i64vec3 first;  // cell
    Candidates candidates;
    glm::dvec3 half_range;  // of the jitter
    std::uint32_t hint;

    FoundPoint answer(const glm::dvec3& p) {
        const ClosestPoint closest =
            candidates.count <= most_candidates
                ? closest_candidate(index, candidates, p, settings.max_distance, hint)
                : index.closest(p, settings.max_distance, hint);
        if (closest.triangle != ClosestPoint::none) hint = closest.triangle;
        return {closest, glm::vec3(p)};
    }

    void run(bool centres, std::array<FoundPoint, block_points>& answers) {
        for (FoundPoint& found : answers) found.closest.triangle = ClosestPoint::none;
        const AxisPlaces x = places(lattice, 0, first.x, centres), y = places(lattice, 1, first.y, centres),
                         z = places(lattice, 2, first.z, centres);
        for (std::int64_t k = 0; k < z.count; ++k) {
            for (std::int64_t j = 0; j < y.count; ++j) {
                const glm::i64vec3 row = first + glm::i64vec3(0, j, k);
                const std::uint64_t id = centres ? centre_id(lattice, row) : corner_id(lattice, row);
                const auto to = static_cast<std::size_t>((k * block_cells + j) * block_cells);
                for (std::size_t i = 0; i < static_cast<std::size_t>(x.count); ++i) {
                    const glm::dvec3 at(x.at[i], y.at[static_cast<std::size_t>(j)],
                                        z.at[static_cast<std::size_t>(k)]);
                    answers[to + i] = answer(at + jitter_offset(id + i, settings.seed, half_range));
                }
            }
        }
    }
};

}  // namespace

void query_block(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, BlockAnswers& answers) {
    const glm::i64vec3 first = block.at * block_cells;
    const BlockBall ball = block_ball(lattice, settings.jitter, first, block_cells);
    BlockQuery query{index,
                     lattice,
                     settings,
                     first,
                     collect(index, ball, block, settings.max_distance),
                     lattice.spacing() * (0.5 * settings.jitter),
                     block.nearest};
    query.run(false, answers.corners);
    query.run(true, answers.centres);
}

}  // namespace astrosplat
