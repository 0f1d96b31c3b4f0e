// Near places, to within a tolerance. In: a point, and clusters from the tree or a list. Out: NearPlace.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "generate/closest_point_state.h"
#include "generate/cluster_filter.h"

namespace astrosplat {

// The search of a near place. The middle of a small triangle's disc, which lies on the triangle, will do: its
// record need not be fetched.
struct ClosestPointIndex::Approach {
    const State& state;
    glm::dvec3 p;
    glm::vec3 local;
    double slack, tolerance;
    NearPlace best;
    float limit;  // of bounds that may still matter

    Approach(const State& all, const glm::dvec3& point, double max_distance, double tolerated)
        : state(all),
          p(point),
          local(point - all.center),
          slack(all.slack(point - all.center)),
          tolerance(tolerated),
          best{ClosestPoint::none, max_distance, {}},
          limit(widened(max_distance, slack)) {}

    // What is left to look for, or a negative number.
    double left() const {
        return best.slot == ClosestPoint::none ? best.distance : best.distance - tolerance;
    }
    void take(const NearPlace& place) {
        best = place;
        limit = left() < 0.0 ? -1.0f : widened(left(), slack);
    }
    void offer(std::uint32_t slot) {
        const TriangleShape s = state.shape(slot);
        const ClosestPoint c = closest_on_triangle(p, s);
        const double distance = std::sqrt(c.distance_squared);
        if (distance < best.distance || (best.slot == ClosestPoint::none && distance == best.distance))
            take({slot, distance, s.a + s.ab * c.barycentric.x + s.ac * c.barycentric.y});
    }
    void offer_cluster(const TriangleCluster& cluster) {
        const auto rounding = static_cast<float>(slack) + 2e-6f * std::max(limit, 0.0f);
        const DiscDistances squared = disc_distances(cluster, local, rounding);
        for (std::size_t i = 0; i < TriangleCluster::size; ++i) {
            if (limit < 0.0f || squared.least[i] > limit * limit) continue;
            const double middle = std::sqrt(squared.middle[i]);
            if (cluster.bound(i).normal == glm::vec3(0.0f) ||
                middle - std::sqrt(squared.least[i]) > tolerance)
                offer(cluster.slot[i]);
            else if (best.slot == ClosestPoint::none || middle < best.distance)
                take({cluster.slot[i], middle, glm::dvec3(cluster.bound(i).center) + state.center});
        }
    }
    // The cluster's box is not asked: a disc may come near where neither box nor triangle does.
    void start(std::uint32_t hint) {
        if (hint != ClosestPoint::none) offer_cluster(state.clusters[hint / TriangleCluster::size]);
    }
};

NearPlace ClosestPointIndex::near_place(const glm::dvec3& p, double max_distance, double tolerance,
                                        std::uint32_t hint) const {
    Approach approach(*state_, p, max_distance, tolerance);
    approach.start(hint);
    if (approach.left() < 0.0) return approach.best;
    state_->query(p, approach.left(), [&](std::uint32_t cluster) {
        approach.offer_cluster(state_->clusters[cluster]);
        return approach.left();
    });
    return approach.best;
}

NearPlace ClosestPointIndex::near_place(const ClusterList& list, const glm::dvec3& p, double max_distance,
                                        double tolerance) const {
    Approach approach(*state_, p, max_distance, tolerance);
    if (list.nearest < list.count) {
        const glm::dvec3 place = glm::dvec3(list.place(list.nearest)) + state_->center;
        const double distance = glm::length(place - p);
        if (distance < max_distance) approach.take({list.slot[list.nearest], distance, place});
    }
    if (approach.limit < 0.0f) return approach.best;
    std::array<std::uint32_t, ClusterList::most + 64> near;
    const std::size_t count = near_clusters(list, approach.limit * approach.limit, near.data());
    for (std::size_t i = 0; i < count && approach.limit >= 0.0f; ++i) {
        if (!(list.squared[near[i]] > approach.limit * approach.limit))
            approach.offer_cluster(state_->clusters[list.cluster[near[i]]]);
    }
    return approach.best;
}

}  // namespace astrosplat
