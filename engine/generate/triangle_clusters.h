// The triangles of meshes in clusters of eight that lie together, with their bounds. In: meshes. Out: arrays,
// in the order of a Hilbert curve.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <span>

#include "core/buffer.h"
#include "generate/candidates.h"
#include "generate/closest_triangle.h"
#include "source/mesh.h"

namespace astrosplat {

/// What is kept of a triangle, in the order of the clusters, so that neighbours lie together in memory. Its
/// place there is its slot.
struct ClusteredTriangle {
    TriangleCorners corners;
    std::uint32_t number;  // over all meshes' triangles in order
    TriangleEdges edges;
};

struct TriangleClusters {
    Buffer<ClusteredTriangle> triangles;  // by slot
    Buffer<std::uint32_t> slots;          // by number
    Buffer<TriangleCluster> clusters;
    Buffer<ClusterBox> boxes;  // of the clusters
    glm::dvec3 center{0.0};    // origin of the bounds, scene units
    double reach = 0.0;        // largest coordinate of a vertex relative to center

    TriangleShape shape(std::uint32_t slot) const { return triangle_shape(triangles[slot].corners); }

    /// How much rounding to float may move a point at `local`, relative to center, and a triangle along any
    /// direction: vertices and point are each off by up to 2^-24 of their coordinates, per axis, so by less
    /// than 1.1e-7 of their sum. Four times that also covers Embree's own subtractions, and the factor in
    /// widened() its squares.
    double slack(const glm::dvec3& local) const {
        const glm::dvec3 size = glm::abs(local);
        return 4e-7 * (reach + std::max({size.x, size.y, size.z}));
    }
};

/// The radius of a search that is to find everything within `distance`.
inline float widened(double distance, double slack) { return static_cast<float>(1.00001 * distance + slack); }

/// Meshes are numbered and concatenated in order. All but what bound_clusters fills in. Throws InputError for
/// more triangles than 32 bits count.
TriangleClusters place_clusters(std::span<const Mesh* const> meshes);
/// The bounds of clusters begin .. end-1 and of their triangles, and the places in their boxes.
void bound_clusters(std::size_t begin, std::size_t end, TriangleClusters& clusters);

}  // namespace astrosplat
