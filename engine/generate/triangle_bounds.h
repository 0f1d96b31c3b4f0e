// What encloses a triangle, for closest-point searches. In: a triangle in double. Out: its disc or ball, the
// planes through its edges and its box, in float, wide enough for what closest_on_triangle may answer.
#pragma once

#include "generate/candidates.h"
#include "generate/closest_triangle.h"

namespace astrosplat {

struct TriangleBounds {
    TriangleBound disc;
    TriangleEdges edges;
};

/// A triangle's box along the axes.
struct TriangleBox {
    glm::vec3 lo, hi;
};

/// Both relative to `origin`.
TriangleBox triangle_box(const TriangleShape& shape, const glm::dvec3& origin);
TriangleBounds triangle_bounds(const TriangleShape& shape, const glm::dvec3& origin);

}  // namespace astrosplat
