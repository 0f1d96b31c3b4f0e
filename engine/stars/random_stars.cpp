// A capsule, the ball swept along one straight part, is drawn by its volume, then a point in it; the point
// counts unless an earlier capsule holds it too. So each place of the union is as likely as any other.
#include "stars/star_set.h"

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"

namespace astrosplat {
namespace {

constexpr std::int64_t stars_per_task = 4096;

double log10_of(double x) { return real::log(x) / ln10; }

StarKind main_sequence_star(double mass) {
    const double temperature = 5772.0 * real::pow(mass, (3.5 - 2.0 * 0.8) / 4.0);
    return {4.83 - 2.5 * 3.5 * log10_of(mass), color_index_of(temperature)};
}

/// The numbers of one star's place, one after the other: as many tries as it takes.
class Draws {
  public:
    Draws(std::uint32_t seed, std::uint64_t id)
        : seed_(shared::as_hash_of_id(seed, id, shared::PURPOSE_STAR_PLACE)) {}

    double uniform() {  // [0, 1)
        return double(shared::as_uniform(shared::as_hash(seed_, count_++, 0, shared::PURPOSE_STAR_PLACE)));
    }

  private:
    std::uint32_t seed_, count_ = 0;
};

glm::dvec3 point_in_ball(Draws& draws) {
    const double z = 2.0 * draws.uniform() - 1.0, turn = 2.0 * real::pi * draws.uniform();
    const double across = std::sqrt(std::max(0.0, 1.0 - z * z)), r = real::pow(draws.uniform(), 1.0 / 3.0);
    return r * glm::dvec3(across * real::cos(turn), across * real::sin(turn), z);
}

struct Capsule {
    glm::dvec3 a{0.0}, along{0.0, 0.0, 1.0};  // end, unit vector
    double length = 0.0;
    double volume_up_to = 0.0;  // with those before, of a radius of 1

    bool holds(const glm::dvec3& p) const {  // for a radius of 1
        const double t = std::clamp(glm::dot(p - a, along), 0.0, length);
        const glm::dvec3 off = p - (a + t * along);
        return glm::dot(off, off) < 1.0;
    }

    glm::dvec3 point(Draws& draws) const {
        const double ball = 4.0 / 3.0 * real::pi, rod = real::pi * length;
        if (draws.uniform() * (ball + rod) < ball) {
            const glm::dvec3 p = point_in_ball(draws);
            return a + p + (glm::dot(p, along) > 0.0 ? length * along : glm::dvec3(0.0));
        }
        const glm::dvec3 side = glm::normalize(std::fabs(along.x) < 0.7 ? glm::cross(along, {1, 0, 0})
                                                                        : glm::cross(along, {0, 1, 0}));
        const double turn = 2.0 * real::pi * draws.uniform(), r = std::sqrt(draws.uniform());
        return a + length * draws.uniform() * along +
               r * (real::cos(turn) * side + real::sin(turn) * glm::cross(along, side));
    }
};

std::vector<Capsule> capsules_of(const StarTube& tube) {
    std::vector<Capsule> capsules;
    double volume = 0.0;
    for (std::size_t i = 0; i < std::max<std::size_t>(1, tube.path.size() - 1); ++i) {
        Capsule c;
        c.a = tube.path[i] / tube.radius;
        const glm::dvec3 way = tube.path[std::min(i + 1, tube.path.size() - 1)] / tube.radius - c.a;
        c.length = glm::length(way);
        if (c.length > 0.0) c.along = way / c.length;
        c.volume_up_to = volume += real::pi * c.length + 4.0 / 3.0 * real::pi;
        capsules.push_back(c);
    }
    return capsules;
}

/// For a radius of 1.
glm::dvec3 place_in(std::span<const Capsule> capsules, Draws draws) {
    for (;;) {
        const double at = draws.uniform() * capsules.back().volume_up_to;
        const auto chosen =
            std::ranges::upper_bound(capsules.first(capsules.size() - 1), at, {}, &Capsule::volume_up_to);
        const glm::dvec3 p = chosen->point(draws);
        if (std::none_of(capsules.begin(), chosen, [&](const Capsule& c) { return c.holds(p); })) return p;
    }
}

void keep_between(std::span<const glm::dvec3> path, double tolerance, std::vector<glm::dvec3>& kept) {
    if (path.size() < 3) return;
    const glm::dvec3 a = path.front(), way = path.back() - a;
    const double square = glm::dot(way, way);
    std::size_t farthest = 0;
    double most = tolerance * tolerance;
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
        const double t = square > 0.0 ? std::clamp(glm::dot(path[i] - a, way) / square, 0.0, 1.0) : 0.0;
        const glm::dvec3 off = path[i] - (a + t * way);
        if (glm::dot(off, off) > most) most = glm::dot(off, off), farthest = i;
    }
    if (farthest == 0) return;
    keep_between(path.first(farthest + 1), tolerance, kept);
    kept.push_back(path[farthest]);
    keep_between(path.subspan(farthest), tolerance, kept);
}

}  // namespace

std::vector<StarKind> kinds_of(const StarCatalogue& catalogue, double limit) {
    std::vector<StarKind> kinds;
    for (const CatalogueStar& star : catalogue.stars)
        if (star.distance_pc > 0.0 && star.magnitude <= limit)
            kinds.push_back({star.magnitude - 5.0 * log10_of(star.distance_pc / 10.0), star.color_index});
    return kinds;
}

std::vector<StarKind> main_sequence() {
    constexpr int parts = 8192;
    constexpr double least = 0.1, most = 30.0, power = -1.35;
    const double first = real::pow(least, power), last = real::pow(most, power);
    std::vector<StarKind> kinds;
    for (int i = 0; i < parts; ++i) {
        const double share = (i + 0.5) / parts;
        kinds.push_back(main_sequence_star(real::pow(first + share * (last - first), 1.0 / power)));
    }
    return kinds;
}

std::vector<glm::dvec3> simplified_path(std::span<const glm::dvec3> path, double tolerance) {
    std::vector<glm::dvec3> kept{path.front()};
    keep_between(path, tolerance, kept);
    if (path.size() > 1 && path.back() != kept.back()) kept.push_back(path.back());
    return kept;
}

SplatSet random_stars(const StarTube& tube, std::span<const StarKind> kinds, std::int64_t count,
                      std::uint32_t seed, const StarScale& scale, const Progress& progress) {
    assert(!tube.path.empty() && tube.radius > 0.0 && !kinds.empty());
    const std::vector<Capsule> capsules = capsules_of(tube);
    const StarColors colors;
    SplatSet set = empty_star_set(count);
    parallel_chunks(count, stars_per_task, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        for (std::int64_t i = begin; i < end; ++i) {
            const auto id = std::uint64_t(i);
            const std::uint64_t hash = shared::as_hash_of_id(seed, id, shared::PURPOSE_STAR_KIND);
            const StarKind& kind = kinds[(hash * kinds.size()) >> 32];
            const glm::vec3 position(tube.radius * place_in(capsules, Draws(seed, id)));
            set.position[i] = position;
            const double parsecs = glm::length(glm::dvec3(position)) / scale.unit;
            const double magnitude = kind.absolute_magnitude + 5.0 * log10_of(parsecs / 10.0);
            set.color[i] = star_light(colors(kind.color_index), magnitude, scale.zero_point);
            set.id[i] = id;
        }
    });
    return set;
}

}  // namespace astrosplat
