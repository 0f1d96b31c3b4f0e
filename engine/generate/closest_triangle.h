// One triangle and the point of it that is closest to another. In: corners in scene units. Out: ClosestPoint,
// in double, by the arithmetic that decides everywhere.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace astrosplat {

struct ClosestPoint {
    double distance_squared;  // square scene units
    std::uint32_t triangle;   // index over all meshes' triangles in order; `none` when nothing is near enough
    glm::dvec2 barycentric;   // weights of the triangle's second and third corner
    static constexpr std::uint32_t none = 0xffffffffu;
};

/// A triangle prepared for closest-point queries: first corner, two edges and their dot products. Scene
/// units.
struct TriangleShape {
    glm::dvec3 a, ab, ac;
    double ab_ab, ab_ac, ac_ac;
};
inline TriangleShape triangle_shape(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const auto dot = [](const glm::dvec3& u, const glm::dvec3& v) {
        return u.x * v.x + u.y * v.y + u.z * v.z;
    };
    const glm::dvec3 ab = b - a, ac = c - a;
    return {a, ab, ac, dot(ab, ab), dot(ab, ac), dot(ac, ac)};
}

/// A triangle as it is kept: its shape costs less to make than to fetch. Scene units.
struct TriangleCorners {
    glm::vec3 a, b, c;
};
inline TriangleShape triangle_shape(const TriangleCorners& t) {
    return triangle_shape(glm::dvec3(t.a), glm::dvec3(t.b), glm::dvec3(t.c));
}

/// Triangles whose angle at the first corner is below 1e-7 rad or that close to 180 degrees have no usable
/// inside and count as their three edges.
inline bool has_no_inside(const TriangleShape& s) {
    const double corners = s.ab_ab * s.ac_ac;
    return !(corners - s.ab_ac * s.ab_ac > 1e-14 * corners);
}

/// Whether a triangle is so narrow at its first corner, below 1e-4 rad, that closest_on_triangle's answer may
/// be off by more than rounding: no bound should be derived from it.
inline bool is_narrow(const TriangleShape& s) {
    const double corners = s.ab_ab * s.ac_ac;
    return !(corners - s.ab_ac * s.ab_ac > 1e-8 * corners);
}

/// Closest point of one triangle (Ericson, Real-Time Collision Detection 5.1.5, with the dot products of the
/// other two corners derived from the first corner's), in double; `triangle` comes back as 0.
ClosestPoint closest_on_triangle(const glm::dvec3& p, const TriangleShape& shape);

/// The order that decides: smaller distance, then lower triangle index.
inline bool nearer(const ClosestPoint& a, const ClosestPoint& b) {
    return a.distance_squared < b.distance_squared ||
           (a.distance_squared == b.distance_squared && a.triangle < b.triangle);
}

}  // namespace astrosplat
