// The closest point of a set of meshes: Embree proposes, our own scalar code decides by (distance squared,
// triangle index), so the answer equals brute force over every triangle on any instruction set (DESIGN 4).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "core/bounds.h"
#include "source/mesh.h"
#include "splats/candidates.h"

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
ClosestPoint closest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c);

/// The order that decides: smaller distance, then lower triangle index.
inline bool nearer(const ClosestPoint& a, const ClosestPoint& b) {
    return a.distance_squared < b.distance_squared ||
           (a.distance_squared == b.distance_squared && a.triangle < b.triangle);
}

/// What is kept of a triangle, in the order of the clusters, so that neighbours lie together in memory. Its
/// place there is its slot.
struct ClusteredTriangle {
    TriangleCorners corners;
    std::uint32_t number;  // over all meshes' triangles in order
    TriangleEdges edges;
};

/// A place on a triangle, to within ClosestPointIndex::slack.
struct NearPlace {
    std::uint32_t slot;  // of the triangle; ClosestPoint::none: no place
    double distance;     // from the point that was asked for, scene units
    glm::dvec3 at;       // scene units
};

class ClosestPointIndex {
  public:
    /// Keeps its own copy of the triangles; meshes are numbered and concatenated in order. Throws InputError
    /// for more triangles than 32 bits count.
    explicit ClosestPointIndex(std::span<const Mesh* const> meshes);
    explicit ClosestPointIndex(std::span<const Mesh> meshes);
    ~ClosestPointIndex();
    ClosestPointIndex(const ClosestPointIndex&) = delete;
    ClosestPointIndex& operator=(const ClosestPointIndex&) = delete;

    /// Closest point within `max_distance` (inclusive), ties to the lowest triangle index. Thread-safe.
    /// `hint` is a triangle that is probably near: it makes the search shorter and changes no result.
    ClosestPoint closest(const glm::dvec3& p, double max_distance,
                         std::uint32_t hint = ClosestPoint::none) const;

    /// The same by trying every triangle: the oracle of the tests.
    ClosestPoint closest_brute_force(const glm::dvec3& p, double max_distance) const;

    /// Puts at least the triangles that come within `radius` of `center` into `candidates`, in any order;
    /// false when they do not fit. Thread-safe.
    void collect(const glm::dvec3& center, double radius, std::vector<std::uint32_t>& clusters) const;

    /// The same with boxes; false when they do not fit.
    bool collect(const glm::dvec3& center, double radius, ClusterList& list) const;

    /// A place on the meshes that is no more than `tolerance` farther than the closest; `none` only if
    /// nothing is within `max_distance`. `hint` is the slot of a triangle that is probably near, or `none`.
    /// Thread-safe.
    NearPlace near_place(const glm::dvec3& p, double max_distance, double tolerance,
                         std::uint32_t hint) const;
    /// The same among the clusters of a list; fills in its `squared`.
    NearPlace near_place(ClusterList& list, const glm::dvec3& p, double max_distance, double tolerance,
                         std::uint32_t hint) const;

    /// Where the float coordinates of candidates have their origin, scene units.
    const glm::dvec3& origin() const;
    /// How much rounding to those coordinates may move a point or a triangle, along any direction, with
    /// plenty of room, for points within `radius` of `center`. Scene units.
    double slack(const glm::dvec3& center, double radius) const;

    /// The closest point of one triangle, numbered.
    ClosestPoint closest_of(std::uint32_t triangle, const glm::dvec3& p) const;
    TriangleShape shape(std::uint32_t triangle) const;  // by number
    const ClusteredTriangle* triangles() const;         // by slot
    const TriangleCluster* clusters() const;            // by number
    /// Whether the bound of the triangle in a slot is a disc, not a ball: it has an area and is not narrow.
    bool has_plane(std::uint32_t slot) const;
    std::int64_t triangle_count() const;

  private:
    struct State;
    struct Search;
    struct Approach;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
