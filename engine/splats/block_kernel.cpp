// Each group is measured against the triangle its neighbours found, then against those candidates whose
// bounds come nearer than what its positions already have: first for the group as a whole, many candidates a
// vector; then, one candidate at a time, for its eight positions.
#include "splats/block_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splats/block_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "core/glsl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace astrosplat::glsl;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "maths.glsl"
#pragma GCC diagnostic pop

constexpr std::size_t group = 8;               // positions
using Doubles = hn::CappedTag<double, group>;  // a group's coordinates, in one vector or several
using Floats = hn::CappedTag<float, group>;
constexpr double no_triangle =
    ClosestPoint::none;  // triangles are compared as doubles, which hold them exactly

// --- positions ---

struct Jitter {
    std::uint32_t seed, purpose;
    double half_range;
};

// As jitter_offset: half_range * (2 uniform - 1), added to the lattice position.
HWY_FLATTEN void add_jitter(const uint* HWY_RESTRICT id_low, const uint* HWY_RESTRICT id_high, Jitter jitter,
                            double* HWY_RESTRICT at) {
    for (std::size_t s = 0; s < block_positions; ++s) {
        const float random = as_uniform(as_hash(jitter.seed, id_low[s], id_high[s], jitter.purpose));
        at[s] = at[s] + jitter.half_range * (2.0 * static_cast<double>(random) - 1.0);
    }
}

void place(const BlockPlaces& places, BlockAnswers& answers) {
    std::array<uint, block_positions> id_low, id_high;
    for (std::size_t k = 0; k < block_cells; ++k) {
        for (std::size_t j = 0; j < block_cells; ++j) {
            for (std::size_t i = 0; i < block_cells; ++i) {
                const std::size_t s = block_slot(i, j, k);
                const std::uint64_t id = places.first_id + i + j * places.row_ids + k * places.slice_ids;
                id_low[s] = static_cast<uint>(id);
                id_high[s] = static_cast<uint>(id >> 32);
                answers.x[s] = places.x[i];
                answers.y[s] = places.y[j];
                answers.z[s] = places.z[k];
            }
        }
    }
    const glm::dvec3& range = places.half_range;
    const auto add = [&](std::uint32_t purpose, double half_range, double* at) HWY_ATTR {
        add_jitter(id_low.data(), id_high.data(), {places.seed, purpose, half_range}, at);
    };
    add(PURPOSE_JITTER_X, range.x, answers.x.data());
    add(PURPOSE_JITTER_Y, range.y, answers.y.data());
    add(PURPOSE_JITTER_Z, range.z, answers.z.data());
}

// --- one group ---

struct Group {
    const double *x, *y, *z;  // scene units
    alignas(64) double squared[group], triangle[group], v[group], w[group];
    alignas(64) float local_x[group], local_y[group], local_z[group];  // in the candidates' coordinates
    alignas(64) float limit[group];  // square of how near a bound must come to matter
    glm::vec3 middle;
    alignas(64) float from_middle[group];
    float widest;  // largest of limit's roots + from_middle
};

struct Vector3 {
    hn::Vec<Doubles> x, y, z;
};

HWY_INLINE hn::Vec<Doubles> dot(const Vector3& a, const Vector3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vector3 set(const glm::dvec3& p) {
    const Doubles d;
    return {hn::Set(d, p.x), hn::Set(d, p.y), hn::Set(d, p.z)};
}

// Ericson's regions as masks: closest_on_triangle without branches, to the same bits, for one vector of
// positions. True when the triangle is nearest for one of them.
HWY_INLINE bool offer(const TriangleShape& s, double number, Group& g, std::size_t i) {
    const Doubles d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0);
    const Vector3 ab = set(s.ab), ac = set(s.ac), a = set(s.a);
    const Vector3 ap{hn::Sub(hn::LoadU(d, g.x + i), a.x), hn::Sub(hn::LoadU(d, g.y + i), a.y),
                     hn::Sub(hn::LoadU(d, g.z + i), a.z)};
    const auto ab_ab = hn::Set(d, s.ab_ab), ab_ac = hn::Set(d, s.ab_ac), ac_ac = hn::Set(d, s.ac_ac);
    const auto d1 = dot(ab, ap), d2 = dot(ac, ap);
    const auto d3 = hn::Sub(d1, ab_ab), d4 = hn::Sub(d2, ab_ac), d5 = hn::Sub(d1, ab_ac),
               d6 = hn::Sub(d2, ac_ac);
    const auto vc = hn::Sub(hn::Mul(d1, d4), hn::Mul(d3, d2));
    const auto vb = hn::Sub(hn::Mul(d5, d2), hn::Mul(d1, d6));
    const auto va = hn::Sub(hn::Mul(d3, d6), hn::Mul(d5, d4));
    const auto to_c = hn::Sub(d4, d3), to_b = hn::Sub(d5, d6);
    const auto all = [](auto m, auto n, auto o) HWY_ATTR { return hn::And(hn::And(m, n), o); };
    const auto at_a = hn::And(hn::Le(d1, zero), hn::Le(d2, zero));
    const auto at_b = hn::And(hn::Ge(d3, zero), hn::Le(d4, d3));
    const auto at_c = hn::And(hn::Ge(d6, zero), hn::Le(d5, d6));
    const auto on_ab = all(hn::Le(vc, zero), hn::Ge(d1, zero), hn::Le(d3, zero));
    const auto on_ac = all(hn::Le(vb, zero), hn::Ge(d2, zero), hn::Le(d6, zero));
    const auto on_bc = all(hn::Le(va, zero), hn::Ge(to_c, zero), hn::Ge(to_b, zero));
    // From the last region Ericson asks for to the first, which wins. One division serves them all.
    auto top = hn::IfThenElse(on_bc, to_c, one);
    top = hn::IfThenElse(on_ab, d1, hn::IfThenElse(on_ac, d2, top));
    auto below = hn::IfThenElse(on_bc, hn::Add(to_c, to_b), hn::Add(hn::Add(va, vb), vc));
    below = hn::IfThenElse(on_ab, ab_ab, hn::IfThenElse(on_ac, ac_ac, below));
    const auto q = hn::Div(top, below);
    auto v = hn::IfThenElse(on_bc, hn::Sub(one, q), hn::Mul(vb, q));
    v = hn::IfThenElse(on_ab, q, hn::IfThenElse(on_ac, zero, v));
    v = hn::IfThenElse(at_b, one, hn::IfThenElse(at_c, zero, v));
    v = hn::IfThenElse(at_a, zero, v);
    auto w = hn::IfThenElse(hn::Or(on_bc, on_ac), q, hn::Mul(vc, q));
    w = hn::IfThenElse(on_ab, zero, w);
    w = hn::IfThenElse(at_b, zero, hn::IfThenElse(at_c, one, w));
    w = hn::IfThenElse(at_a, zero, w);
    const auto left = [&](auto p, auto b, auto c)
                          HWY_ATTR { return hn::Sub(hn::Sub(p, hn::Mul(b, v)), hn::Mul(c, w)); };
    const Vector3 r{left(ap.x, ab.x, ac.x), left(ap.y, ab.y, ac.y), left(ap.z, ab.z, ac.z)};
    const auto squared = dot(r, r);
    const auto best = hn::Load(d, g.squared + i), triangle = hn::Load(d, g.triangle + i);
    const auto this_one = hn::Set(d, number);
    const auto tie_won = hn::And(hn::Eq(squared, best), hn::Lt(this_one, triangle));
    const auto nearer = hn::Or(hn::Lt(squared, best), tie_won);
    if (hn::AllFalse(d, nearer)) return false;
    hn::Store(hn::IfThenElse(nearer, squared, best), d, g.squared + i);
    hn::Store(hn::IfThenElse(nearer, this_one, triangle), d, g.triangle + i);
    hn::Store(hn::IfThenElse(nearer, v, hn::Load(d, g.v + i)), d, g.v + i);
    hn::Store(hn::IfThenElse(nearer, w, hn::Load(d, g.w + i)), d, g.w + i);
    return true;
}

// Triangles without a usable inside, by the scalar code.
bool offer_thin(const TriangleShape& shape, double number, Group& g) {
    bool any = false;
    for (std::size_t i = 0; i < group; ++i) {
        const ClosestPoint c = closest_on_triangle({g.x[i], g.y[i], g.z[i]}, shape);
        const bool tie_won = c.distance_squared == g.squared[i] && number < g.triangle[i];
        if (!(c.distance_squared < g.squared[i] || tie_won)) continue;
        any = true;
        g.squared[i] = c.distance_squared;
        g.triangle[i] = number;
        g.v[i] = c.barycentric.x;
        g.w[i] = c.barycentric.y;
    }
    return any;
}

class GroupQuery {
  public:
    GroupQuery(const BlockMeasure& measure, NearCandidates& found) : m_(measure), found_(found) {}

    void start(BlockAnswers& answers, std::size_t first) {
        g_.x = &answers.x[first], g_.y = &answers.y[first], g_.z = &answers.z[first];
        to_local(g_.x, m_.origin.x, g_.local_x);
        to_local(g_.y, m_.origin.y, g_.local_y);
        to_local(g_.z, m_.origin.z, g_.local_z);
        std::fill_n(g_.squared, group, m_.max_distance * m_.max_distance);
        std::fill_n(g_.triangle, group, no_triangle);
        std::fill_n(g_.v, group, 0.0);
        std::fill_n(g_.w, group, 0.0);
        find_middle();
    }

    void run(std::uint32_t hint) {
        if (hint != ClosestPoint::none) measure(hint);
        update_limits();
        scan();
        if (found_.count == 0) return;
        const float* nearest = std::min_element(found_.squared.data(), found_.squared.data() + found_.count);
        const std::uint32_t first = number(static_cast<std::size_t>(nearest - found_.squared.data()));
        if (first != hint && measure(first)) update_limits();
        std::uint32_t before = first;  // clusters may repeat their last triangle
        for (std::size_t i = 0; i < found_.count; ++i) {
            const std::uint32_t triangle = number(i);
            if (triangle == hint || triangle == first || triangle == before) continue;
            before = triangle;
            if (found_.squared[i] > g_.widest * g_.widest || !matters(found_.place[i])) continue;
            if (measure(triangle)) update_limits();
        }
    }

    void finish(BlockAnswers& answers, std::size_t first) const {
        for (std::size_t i = 0; i < group; ++i) {
            answers.distance_squared[first + i] = g_.squared[i];
            answers.triangle[first + i] = static_cast<std::uint32_t>(g_.triangle[i]);
            answers.v[first + i] = g_.v[i];
            answers.w[first + i] = g_.w[i];
        }
    }

  private:
    static void to_local(const double* at, double origin, float* local) {
        for (std::size_t i = 0; i < group; ++i) local[i] = static_cast<float>(at[i] - origin);
    }

    void find_middle() {
        g_.middle = {middle_of(g_.local_x), middle_of(g_.local_y), middle_of(g_.local_z)};
        const Floats d;
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto x = hn::Sub(hn::Load(d, g_.local_x + i), hn::Set(d, g_.middle.x));
            const auto y = hn::Sub(hn::Load(d, g_.local_y + i), hn::Set(d, g_.middle.y));
            const auto z = hn::Sub(hn::Load(d, g_.local_z + i), hn::Set(d, g_.middle.z));
            const auto squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
            hn::Store(hn::Mul(hn::Sqrt(squared), hn::Set(d, 1.00001f)), d, g_.from_middle + i);
        }
    }
    static float middle_of(const float* values) {
        const Floats d;
        auto lowest = hn::Load(d, values), highest = lowest;
        for (std::size_t i = hn::Lanes(d); i < group; i += hn::Lanes(d)) {
            lowest = hn::Min(lowest, hn::Load(d, values + i));
            highest = hn::Max(highest, hn::Load(d, values + i));
        }
        return 0.5f * (hn::GetLane(hn::MinOfLanes(d, lowest)) + hn::GetLane(hn::MaxOfLanes(d, highest)));
    }

    // True when the triangle is nearest for a position of the group.
    bool measure(std::uint32_t triangle) {
        const TriangleShape& s = m_.shapes[triangle];
        if (has_no_inside(s)) return offer_thin(s, triangle, g_);
        bool any = false;
        for (std::size_t i = 0; i < group; i += hn::Lanes(Doubles())) any |= offer(s, triangle, g_, i);
        return any;
    }

    // As ClosestPointIndex's queries widen their radius.
    void update_limits() {
        alignas(64) float distance[group];
        for (std::size_t i = 0; i < group; ++i) distance[i] = static_cast<float>(std::sqrt(g_.squared[i]));
        const Floats d;
        auto widest = hn::Zero(d);
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto limit =
                hn::Add(hn::Mul(hn::Load(d, distance + i), hn::Set(d, 1.00001f)), hn::Set(d, m_.slack));
            hn::Store(hn::Mul(limit, limit), d, g_.limit + i);
            widest = hn::Max(widest, hn::Add(limit, hn::Load(d, g_.from_middle + i)));
        }
        g_.widest = hn::GetLane(hn::MaxOfLanes(d, widest)) * 1.00001f + m_.slack;
    }

    // Square of at most the distance of a point from a disc, for lanes of candidates or of positions; right
    // wherever the disc is within `widest`. The small numbers outweigh the rounding of the normal, of the
    // subtraction of nearly equal squares, and of the approximate root.
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V from_disc(D d, V x, V y, V z, V normal_x, V normal_y, V normal_z, V radius) const {
        const V squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
        const V height =
            hn::Abs(hn::Add(hn::Add(hn::Mul(x, normal_x), hn::Mul(y, normal_y)), hn::Mul(z, normal_z)));
        const V across_squared = hn::Max(
            hn::Sub(hn::Mul(squared, hn::Set(d, 1.0f - 4e-6f)), hn::Mul(height, height)), hn::Set(d, 1e-30f));
        const V across = hn::Mul(hn::Mul(across_squared, hn::ApproximateReciprocalSqrt(across_squared)),
                                 hn::Set(d, 0.9995f));
        const V outside = hn::Max(hn::Sub(across, radius), hn::Zero(d));
        const V margin = hn::Mul(hn::Add(radius, hn::Set(d, g_.widest)), hn::Set(d, 2e-6f));
        const V above = hn::Max(hn::Sub(height, margin), hn::Zero(d));
        return hn::Add(hn::Mul(outside, outside), hn::Mul(above, above));
    }

    // Whether a candidate may be nearer to one of the group's positions than what that has.
    bool matters(std::size_t place) const {
        const Floats d;
        const CandidateList& c = m_.candidates;
        const auto normal_x = hn::Set(d, c.normal_x[place]), normal_y = hn::Set(d, c.normal_y[place]),
                   normal_z = hn::Set(d, c.normal_z[place]), radius = hn::Set(d, c.radius[place]);
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto x = hn::Sub(hn::Load(d, g_.local_x + i), hn::Set(d, c.center_x[place]));
            const auto y = hn::Sub(hn::Load(d, g_.local_y + i), hn::Set(d, c.center_y[place]));
            const auto z = hn::Sub(hn::Load(d, g_.local_z + i), hn::Set(d, c.center_z[place]));
            const auto squared = from_disc(d, x, y, z, normal_x, normal_y, normal_z, radius);
            if (!hn::AllFalse(d, hn::Le(squared, hn::Load(d, g_.limit + i)))) return true;
        }
        return false;
    }

    // Candidates whose bounds come within `widest` of the group's middle.
    void scan() {
        const hn::ScalableTag<float> d;
        const hn::RebindToUnsigned<decltype(d)> du;
        const CandidateList& c = m_.candidates;
        const auto limit = hn::Set(d, g_.widest * g_.widest);
        const auto px = hn::Set(d, g_.middle.x), py = hn::Set(d, g_.middle.y), pz = hn::Set(d, g_.middle.z);
        const auto outside = [&](const float* lo, const float* hi, auto p) HWY_ATTR {
            return hn::Max(hn::Max(hn::Sub(hn::LoadU(d, lo), p), hn::Sub(p, hn::LoadU(d, hi))), hn::Zero(d));
        };
        std::size_t count = 0;
        for (std::size_t i = 0; i < c.count; i += hn::Lanes(d)) {
            const auto x = outside(&c.lo_x[i], &c.hi_x[i], px), y = outside(&c.lo_y[i], &c.hi_y[i], py),
                       z = outside(&c.lo_z[i], &c.hi_z[i], pz);
            const auto from_box = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
            auto near_group = hn::And(hn::Le(from_box, limit), hn::FirstN(d, c.count - i));
            if (hn::AllFalse(d, near_group)) continue;
            const auto disc = from_disc(
                d, hn::Sub(px, hn::LoadU(d, &c.center_x[i])), hn::Sub(py, hn::LoadU(d, &c.center_y[i])),
                hn::Sub(pz, hn::LoadU(d, &c.center_z[i])), hn::LoadU(d, &c.normal_x[i]),
                hn::LoadU(d, &c.normal_y[i]), hn::LoadU(d, &c.normal_z[i]), hn::LoadU(d, &c.radius[i]));
            near_group = hn::And(near_group, hn::Le(disc, limit));
            const auto places = hn::Iota(du, static_cast<std::uint32_t>(i));
            hn::CompressStore(hn::Max(from_box, disc), near_group, d, &found_.squared[count]);
            count += hn::CompressStore(places, hn::RebindMask(du, near_group), du, &found_.place[count]);
        }
        found_.count = count;
    }

    std::uint32_t number(std::size_t found) const { return m_.candidates.triangle[found_.place[found]]; }

    const BlockMeasure& m_;
    NearCandidates& found_;
    Group g_;
};

void measure_all(const BlockMeasure& measure, NearCandidates& scratch, BlockAnswers& answers) {
    GroupQuery query(measure, scratch);
    std::uint32_t hint = measure.nearest;
    for (std::size_t first = 0; first < block_positions; first += group) {
        query.start(answers, first);
        query.run(hint);
        query.finish(answers, first);
        for (std::size_t i = 0; i < group; ++i)
            if (answers.triangle[first + i] != ClosestPoint::none) hint = answers.triangle[first + i];
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(place);
HWY_EXPORT(measure_all);

void place_block(const BlockPlaces& places, BlockAnswers& answers) {
    HWY_DYNAMIC_DISPATCH(place)(places, answers);
}

void measure_block(const BlockMeasure& measure, NearCandidates& scratch, BlockAnswers& answers) {
    HWY_DYNAMIC_DISPATCH(measure_all)(measure, scratch, answers);
}

}  // namespace astrosplat
#endif
