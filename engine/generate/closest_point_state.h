// What a ClosestPointIndex holds, for the files that search in it: the clusters, and the tree over their
// boxes.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/parallel.h"
#include "generate/closest_point.h"
#include "generate/cluster_tree.h"
#include "generate/triangle_clusters.h"

namespace astrosplat {

struct ClosestPointIndex::State : TriangleClusters {
    ClusterTree tree;

    /// The tree is built beside the bounds: by one thread, because Embree's threads are not ours. It reads
    /// the boxes' sides only, not the places that are filled in meanwhile.
    explicit State(std::span<const Mesh* const> meshes) : TriangleClusters(place_clusters(meshes)) {
        constexpr std::size_t chunk = 512;
        const std::size_t chunks = (clusters.size() + chunk - 1) / chunk;
        parallel_for(static_cast<std::int64_t>(1 + chunks), [&](std::int64_t task, int) {
            if (task == 0) return tree.build(boxes);
            const std::size_t begin = (static_cast<std::size_t>(task) - 1) * chunk;
            bound_clusters(begin, std::min(begin + chunk, clusters.size()), *this);
        });
    }

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
