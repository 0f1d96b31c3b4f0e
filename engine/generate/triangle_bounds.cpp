// Bounds from a triangle's smallest circle, its unit normal and its corners.
#include "generate/triangle_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace astrosplat {
namespace {

double squared_length(const glm::dvec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

// The middle of the smallest circle around a triangle, from its first corner: the circumcentre where all
// angles are acute, else the middle of the longest side.
glm::dvec3 circle_middle(const TriangleShape& s) {
    const double at_b = s.ab_ab - s.ab_ac, at_c = s.ac_ac - s.ab_ac;
    if (has_no_inside(s) || s.ab_ac <= 0.0 || at_b <= 0.0 || at_c <= 0.0) {
        const double bc_bc = at_b + at_c;
        if (s.ab_ab >= s.ac_ac && s.ab_ab >= bc_bc) return s.ab * 0.5;
        return s.ac_ac >= bc_bc ? s.ac * 0.5 : (s.ab + s.ac) * 0.5;
    }
    const double area_squared = s.ab_ab * s.ac_ac - s.ab_ac * s.ab_ac;
    return (s.ab * (s.ac_ac * at_b) + s.ac * (s.ab_ab * at_c)) / (2.0 * area_squared);
}

// How far closest_on_triangle may place a point outside the triangle, as a part of its size.
double overshoot(const TriangleShape& s) {
    const double corners = s.ab_ab * s.ac_ac;
    const double sine_squared = corners > 0.0 ? (corners - s.ab_ac * s.ab_ac) / corners : 0.0;
    return 1e-6 + (sine_squared > 1e-14 ? 1e-15 / sine_squared : 0.0);
}

// Unit, or 0 for triangles that have no plane worth a bound.
glm::dvec3 usable_normal(const TriangleShape& s) {
    const glm::dvec3 normal = glm::cross(s.ab, s.ac);
    const double length = std::sqrt(squared_length(normal));
    return length > 0.0 && !is_narrow(s) ? normal / length : glm::dvec3(0.0);
}

}  // namespace

TriangleBox triangle_box(const TriangleShape& s, const glm::dvec3& origin) {
    const glm::dvec3 a = s.a - origin, b = a + s.ab, c = a + s.ac;
    const glm::dvec3 lo = glm::min(glm::min(a, b), c), hi = glm::max(glm::max(a, b), c);
    const glm::dvec3 more = (hi - lo) * overshoot(s);
    return {glm::vec3(lo - more), glm::vec3(hi + more)};
}

TriangleDisc triangle_disc(const TriangleShape& s, const glm::dvec3& origin) {
    const glm::dvec3 middle = circle_middle(s);
    const double radius = std::sqrt(
        std::max({squared_length(middle), squared_length(middle - s.ab), squared_length(middle - s.ac)}));
    return {glm::vec3(s.a - origin + middle), glm::vec3(usable_normal(s)),
            static_cast<float>(radius * (1.0 + overshoot(s)))};
}

}  // namespace astrosplat
