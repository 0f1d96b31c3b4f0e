// What encloses a triangle, for closest-point searches. In: a triangle in double. Out: its disc and its box
// in float, relative to an origin, wide enough for what closest_on_triangle may answer.
#pragma once

#include <glm/vec3.hpp>

#include "generate/closest_triangle.h"

namespace astrosplat {

/// A disc around a triangle in its plane; where the normal is 0, as for triangles that are too narrow to have
/// a plane worth a bound, a ball. The middle of a disc lies on its triangle.
struct TriangleDisc {
    glm::vec3 center, normal;
    float radius;
    bool has_plane() const { return normal != glm::vec3(0.0f); }
};

struct TriangleBox {
    glm::vec3 lo, hi;
};

TriangleDisc triangle_disc(const TriangleShape& shape, const glm::dvec3& origin);
TriangleBox triangle_box(const TriangleShape& shape, const glm::dvec3& origin);

}  // namespace astrosplat
