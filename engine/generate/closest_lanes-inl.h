// Eight positions and one triangle: the exact closest points, as closest_on_triangle gives them. Included
// once per instruction set.
#if defined(ASTROSPLAT_GENERATE_CLOSEST_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_GENERATE_CLOSEST_LANES_INL_H
#undef ASTROSPLAT_GENERATE_CLOSEST_LANES_INL_H
#else
#define ASTROSPLAT_GENERATE_CLOSEST_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "generate/triangle_tree.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t group = 8;               // positions
using Doubles = hn::CappedTag<double, group>;  // a group's coordinates, in one vector or several

/// Positions, and the best answer so far for each: arrays of whole groups.
struct BestAnswers {
    const double *x, *y, *z;             // scene units
    double *squared, *triangle, *v, *w;  // as ClosestPoint; triangles' numbers are exact
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

struct ClosestLanes {
    hn::Vec<Doubles> squared, v, w;  // as ClosestPoint
};

// Ericson's regions as masks: closest_on_triangle without branches, to the same bits.
HWY_INLINE ClosestLanes closest_lanes(const TriangleShape& s, const Vector3& p) {
    const Doubles d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0);
    const Vector3 ab = set(s.ab), ac = set(s.ac), a = set(s.a);
    const Vector3 ap{hn::Sub(p.x, a.x), hn::Sub(p.y, a.y), hn::Sub(p.z, a.z)};
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
    const auto left = [&](auto from, auto b, auto c)
                          HWY_ATTR { return hn::Sub(hn::Sub(from, hn::Mul(b, v)), hn::Mul(c, w)); };
    const Vector3 r{left(ap.x, ab.x, ac.x), left(ap.y, ab.y, ac.y), left(ap.z, ab.z, ac.z)};
    return {dot(r, r), v, w};
}

// For the vector of positions from place i on. True when the triangle is nearest for one of them.
HWY_INLINE bool offer(const TriangleShape& s, double number, const BestAnswers& g, std::size_t i) {
    const Doubles d;
    const ClosestLanes c =
        closest_lanes(s, {hn::LoadU(d, g.x + i), hn::LoadU(d, g.y + i), hn::LoadU(d, g.z + i)});
    const auto best = hn::Load(d, g.squared + i), triangle = hn::Load(d, g.triangle + i);
    const auto this_one = hn::Set(d, number);
    const auto tie_won = hn::And(hn::Eq(c.squared, best), hn::Lt(this_one, triangle));
    const auto nearer = hn::Or(hn::Lt(c.squared, best), tie_won);
    if (hn::AllFalse(d, nearer)) return false;
    hn::Store(hn::IfThenElse(nearer, c.squared, best), d, g.squared + i);
    hn::Store(hn::IfThenElse(nearer, this_one, triangle), d, g.triangle + i);
    hn::Store(hn::IfThenElse(nearer, c.v, hn::Load(d, g.v + i)), d, g.v + i);
    hn::Store(hn::IfThenElse(nearer, c.w, hn::Load(d, g.w + i)), d, g.w + i);
    return true;
}

// The same for a triangle without a usable inside, by the scalar code, and for one position.
inline void offer_thin(const TriangleShape& shape, double number, const BestAnswers& g, std::size_t i) {
    const ClosestPoint c = closest_on_triangle({g.x[i], g.y[i], g.z[i]}, shape);
    const bool tie_won = c.distance_squared == g.squared[i] && number < g.triangle[i];
    if (!(c.distance_squared < g.squared[i] || tie_won)) return;
    g.squared[i] = c.distance_squared, g.triangle[i] = number;
    g.v[i] = c.barycentric.x, g.w[i] = c.barycentric.y;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#endif  // toggle
