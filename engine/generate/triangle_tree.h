// The triangles of meshes in a tree of boxes (README.md). In: meshes. Out: arrays, and the closest point of
// one position. Boxes are in float and only propose; doubles decide, by (distance squared, triangle number).
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "generate/closest_triangle.h"
#include "generate/triangle_bounds.h"
#include "source/mesh.h"

namespace astrosplat {

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
inline float widened(double distance, double slack) { return static_cast<float>(1.00001 * distance + slack); }

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
