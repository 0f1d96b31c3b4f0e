// The closest point of a set of meshes: Embree proposes, our own scalar code decides by (distance squared, triangle
// index), so the answer equals brute force over every triangle on any instruction set (DESIGN 4).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "source/mesh.h"

namespace astrosplat {

struct ClosestPoint {
    double distance_squared;   // square scene units
    std::uint32_t triangle;    // index over all meshes' triangles in order; `none` when nothing is near enough
    glm::dvec2 barycentric;    // weights of the triangle's second and third corner
    static constexpr std::uint32_t none = 0xffffffffu;
};

/// Closest point of one triangle (Ericson, Real-Time Collision Detection 5.1.5), in double.
ClosestPoint closest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

class ClosestPointIndex {
  public:
    /// Keeps its own copy of the triangles; meshes are numbered and concatenated in order.
    explicit ClosestPointIndex(std::span<const Mesh> meshes);
    ~ClosestPointIndex();
    ClosestPointIndex(const ClosestPointIndex&) = delete;
    ClosestPointIndex& operator=(const ClosestPointIndex&) = delete;

    /// Closest point within `max_distance` (inclusive), ties to the lowest triangle index. Thread-safe.
    ClosestPoint closest(const glm::dvec3& p, double max_distance) const;

    /// The same by trying every triangle: the oracle of the tests.
    ClosestPoint closest_brute_force(const glm::dvec3& p, double max_distance) const;

    std::int64_t triangle_count() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
