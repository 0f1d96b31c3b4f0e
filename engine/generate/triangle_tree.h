// The triangles of meshes in a tree of boxes (README.md). In: meshes in scene units. Out: arrays, and the
// closest point to one position. Enclosing discs and boxes are in float, relative to an origin, and only
// propose, wide enough for what closest_on_triangle may answer; doubles decide, the same everywhere, by
// (distance squared, triangle number).
#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/buffer.h"
#include "source/mesh.h"

namespace astrosplat {

struct ClosestPoint {
    double distance_squared;  // square scene units
    std::uint32_t triangle;   // index over all meshes' triangles in order; `none` when nothing is near enough
    glm::dvec2 barycentric;   // weights of the triangle's second and third corner
    static constexpr std::uint32_t none = 0xffffffffu;
};

/// A triangle prepared for closest-point queries: first corner, two edges and their dot products.
/// Scene units.
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

/// A disc around a triangle in its plane; where the normal is 0, as for triangles that are too narrow to have
/// a plane worth a bound, a ball. The middle of a disc lies on its triangle.
struct TriangleDisc {
    glm::vec3 center, normal;
    float radius;
    bool has_plane() const { return normal != glm::vec3(0.0f); }
};

/// A triangle as the tree keeps it: neighbours lie together. Its place in the order is its slot.
struct TreeTriangle {
    TriangleCorners corners;
    std::uint32_t number;  // over all meshes' triangles in order
    TriangleDisc disc;     // relative to the tree's origin
};

/// Boxes relative to the tree's origin, scene units; arrays end with room for a whole group of eight.
struct TreeLevel {
    std::size_t count = 0;
    Buffer<float> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
};

/// Box i of a level is around boxes 8 i .. 8 i + 7 of the level below.
struct TriangleTree {
    static constexpr std::size_t fan = 8;
    Buffer<TreeTriangle> triangles;  // by slot
    std::vector<TreeLevel> levels;   // first those of the triangles, by slot; the last has at most 8 boxes
    glm::dvec3 origin{0.0};          // scene units
    double reach = 0.0;              // largest coordinate of a vertex relative to the origin

    TriangleShape shape(std::uint32_t slot) const { return triangle_shape(triangles[slot].corners); }

    /// How much rounding to float may move a point at `local`, relative to the origin, and a triangle along
    /// any direction: vertices and point are each off by up to 2^-24 of their coordinates, per axis, so by
    /// less than 1.1e-7 of their sum. Four times that leaves plenty of room.
    double slack(const glm::dvec3& local) const {
        const glm::dvec3 size = glm::abs(local);
        return 4e-7 * (reach + std::max({size.x, size.y, size.z}));
    }
};

/// The radius of a search that is to find everything within `distance`, in spite of float.
inline float widened(double distance, double slack) { return float(1.00001 * distance + slack); }

/// Meshes are numbered and concatenated in order. Throws InputError for more triangles than 32 bits count.
TriangleTree make_triangle_tree(std::span<const Mesh* const> meshes);

struct NearTriangle {
    ClosestPoint closest;
    std::uint32_t slot;  // of closest.triangle; ClosestPoint::none: nothing is near enough
};

/// Closest point within `max_distance` (inclusive), ties to the lowest triangle number: brute force's answer.
/// `hint` is the slot of a triangle that is probably near, or `none`: it makes the search shorter and changes
/// no result. Thread-safe.
NearTriangle closest_point(const TriangleTree& tree, const glm::dvec3& p, double max_distance,
                           std::uint32_t hint = ClosestPoint::none);

}  // namespace astrosplat
