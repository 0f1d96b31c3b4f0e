// What a ClosestPointIndex holds, for the files that search in it: the clusters, and the tree over their
// boxes.
#pragma once

#include <array>
#include <span>
#include <utility>

#include "splats/closest_point.h"
#include "splats/cluster_tree.h"
#include "splats/triangle_clusters.h"

namespace astrosplat {

struct ClosestPointIndex::State : TriangleClusters {
    ClusterTree tree;

    explicit State(std::span<const Mesh* const> meshes)
        : TriangleClusters(make_clusters(meshes)), tree(boxes) {}

    /// For at least every cluster with a triangle within `distance`; see ClusterTree::query.
    template <class Visit>
    void query(const glm::dvec3& p, double distance, Visit visit) const {
        const glm::dvec3 local = p - center;
        tree.query(local, distance, slack(local), std::move(visit));
    }
};

// Squares of at most the distances of p from a cluster's triangles; `rounding` is more than theirs amounts
// to.
struct DiscDistances {
    std::array<float, TriangleCluster::size> least;   // as said
    std::array<float, TriangleCluster::size> middle;  // of the discs' middles, square scene units
};
DiscDistances disc_distances(const TriangleCluster& cluster, const glm::vec3& p, float rounding);

}  // namespace astrosplat
