// Ericson's regions of a triangle; one without a usable inside counts as its three edges.
#include "generate/closest_triangle.h"

#include <algorithm>

namespace astrosplat {
namespace {

double squared(const glm::dvec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }
double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ClosestPoint at(const glm::dvec3& ap, const TriangleShape& s, double v, double w) {
    return {squared(ap - s.ab * v - s.ac * w), 0, {v, w}};
}

// Parameter in [0, 1] of the closest point on the segment from the origin along `edge`; 0 for a segment of no
// length.
double along(const glm::dvec3& p, const glm::dvec3& edge) {
    const double length_squared = squared(edge);
    return length_squared > 0.0 ? std::clamp(dot(p, edge) / length_squared, 0.0, 1.0) : 0.0;
}

ClosestPoint closest_on_edges(const glm::dvec3& ap, const TriangleShape& s) {
    const double t_ab = along(ap, s.ab), t_ac = along(ap, s.ac), t_bc = along(ap - s.ab, s.ac - s.ab);
    ClosestPoint best = at(ap, s, t_ab, 0.0);
    for (const ClosestPoint& other : {at(ap, s, 0.0, t_ac), at(ap, s, 1.0 - t_bc, t_bc)}) {
        if (other.distance_squared < best.distance_squared) best = other;
    }
    return best;
}

}  // namespace

ClosestPoint closest_on_triangle(const glm::dvec3& p, const TriangleShape& s) {
    const glm::dvec3 ap = p - s.a;
    const double d1 = dot(s.ab, ap), d2 = dot(s.ac, ap);  // from a; from b and c the same dot products follow
    const double d3 = d1 - s.ab_ab, d4 = d2 - s.ab_ac;
    const double d5 = d1 - s.ab_ac, d6 = d2 - s.ac_ac;
    if (has_no_inside(s)) return closest_on_edges(ap, s);
    if (d1 <= 0.0 && d2 <= 0.0) return at(ap, s, 0.0, 0.0);
    if (d3 >= 0.0 && d4 <= d3) return at(ap, s, 1.0, 0.0);
    if (d6 >= 0.0 && d5 <= d6) return at(ap, s, 0.0, 1.0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return at(ap, s, d1 / s.ab_ab, 0.0);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return at(ap, s, 0.0, d2 / s.ac_ac);
    const double va = d3 * d6 - d5 * d4;
    const double to_c = d4 - d3, to_b = d5 - d6;
    if (va <= 0.0 && to_c >= 0.0 && to_b >= 0.0) {
        const double w = to_c / (to_c + to_b);
        return at(ap, s, 1.0 - w, w);
    }
    const double scale = 1.0 / (va + vb + vc);
    return at(ap, s, vb * scale, vc * scale);
}

}  // namespace astrosplat
