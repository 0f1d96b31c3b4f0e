// The closest point of a set of meshes: Embree proposes, our own scalar code decides by (distance squared,
// triangle index), so the answer equals brute force over every triangle on any instruction set (DESIGN 4).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "generate/candidates.h"
#include "generate/closest_triangle.h"
#include "generate/triangle_clusters.h"
#include "source/mesh.h"

namespace astrosplat {

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

    /// Puts at least the clusters with a triangle that comes within `radius` of `center` into `clusters`, in
    /// any order; none when there are none. Thread-safe.
    void collect(const glm::dvec3& center, double radius, std::vector<std::uint32_t>& clusters) const;

    /// The same clusters with their boxes; false when they do not fit, and `list` is of no use then.
    bool collect(const glm::dvec3& center, double radius, ClusterList& list) const;

    /// A place on the meshes that is no more than `tolerance` farther than the closest; `none` only if
    /// nothing is within `max_distance`. It may itself be farther than that by `tolerance`, so a place does
    /// not mean that something is within. `hint` is the slot of a triangle that is probably near, or `none`.
    /// Thread-safe.
    NearPlace near_place(const glm::dvec3& p, double max_distance, double tolerance,
                         std::uint32_t hint) const;
    /// The same among the clusters of a list that was measured from `p` (measure_boxes).
    NearPlace near_place(const ClusterList& list, const glm::dvec3& p, double max_distance,
                         double tolerance) const;

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
