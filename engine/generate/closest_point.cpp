// Closest points. In: meshes and query points. Out: ClosestPoint. The tree proposes clusters for radii
// widened by more than its roundings can amount to, discs in float sort out their triangles, and each
// triangle left is measured in double from the unrounded vertices.
#include "generate/closest_point.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "generate/closest_point_state.h"

namespace astrosplat {

DiscDistances disc_distances(const TriangleCluster& c, const glm::vec3& p, float rounding) {
    DiscDistances squared;
    for (std::size_t i = 0; i < TriangleCluster::size; ++i) {
        const float x = p.x - c.center_x[i], y = p.y - c.center_y[i], z = p.z - c.center_z[i];
        const float height = x * c.normal_x[i] + y * c.normal_y[i] + z * c.normal_z[i];
        squared.middle[i] = x * x + y * y + z * z;
        const float flat = squared.middle[i] * (1.0f - 4e-6f) - height * height;
        const float off = rounding + 2e-6f * c.radius[i];
        const float outside = std::max(std::sqrt(std::max(flat, 0.0f)) - c.radius[i] - off, 0.0f);
        const float above = std::max(std::fabs(height) - off, 0.0f);
        squared.least[i] = outside * outside + above * above;
    }
    return squared;
}

ClosestPointIndex::ClosestPointIndex(std::span<const Mesh* const> meshes)
    : state_(std::make_unique<State>(meshes)) {}

static std::vector<const Mesh*> pointers_to(std::span<const Mesh> meshes) {
    std::vector<const Mesh*> pointers;
    for (const Mesh& mesh : meshes) pointers.push_back(&mesh);
    return pointers;
}

ClosestPointIndex::ClosestPointIndex(std::span<const Mesh> meshes) : ClosestPointIndex(pointers_to(meshes)) {}

ClosestPointIndex::~ClosestPointIndex() = default;

// The search of one point, cluster by cluster.
struct ClosestPointIndex::Search {
    const State& state;
    glm::dvec3 p;
    glm::vec3 local;
    double slack;
    ClosestPoint best;
    float limit = 0.0f;  // of bounds that may still matter

    Search(const State& all, const glm::dvec3& point, double max_distance)
        : state(all),
          p(point),
          local(point - all.center),
          slack(all.slack(point - all.center)),
          best{max_distance * max_distance, ClosestPoint::none, {}} {
        update_limit();
    }
    void update_limit() { limit = widened(std::sqrt(best.distance_squared), slack); }
    void offer(std::uint32_t slot) {
        ClosestPoint other = closest_on_triangle(p, state.shape(slot));
        other.triangle = state.triangles[slot].number;
        if (!nearer(other, best)) return;
        best = other;
        update_limit();
    }
    void offer_cluster(const TriangleCluster& cluster) {
        const auto rounding = static_cast<float>(slack) + 2e-6f * limit;
        const auto squared = disc_distances(cluster, local, rounding);
        for (std::size_t i = 0; i < TriangleCluster::size; ++i)
            if (!(squared.least[i] > limit * limit)) offer(cluster.slot[i]);
    }
};

ClosestPoint ClosestPointIndex::closest(const glm::dvec3& p, double max_distance, std::uint32_t hint) const {
    Search search(*state_, p, max_distance);
    if (hint != ClosestPoint::none) search.offer(state_->slots[hint]);
    state_->query(p, std::sqrt(search.best.distance_squared), [&](std::uint32_t cluster) {
        search.offer_cluster(state_->clusters[cluster]);
        return std::sqrt(search.best.distance_squared);
    });
    return search.best;
}

ClosestPoint ClosestPointIndex::closest_brute_force(const glm::dvec3& p, double max_distance) const {
    ClosestPoint best{max_distance * max_distance, ClosestPoint::none, {}};
    for (std::uint32_t triangle = 0; triangle < state_->slots.size(); ++triangle) {
        const ClosestPoint other = closest_of(triangle, p);
        if (nearer(other, best)) best = other;
    }
    return best;
}

void ClosestPointIndex::collect(const glm::dvec3& center, double radius,
                                std::vector<std::uint32_t>& clusters) const {
    clusters.clear();
    state_->query(center, radius, [&](std::uint32_t cluster) {
        clusters.push_back(cluster);
        return radius;
    });
}

bool ClosestPointIndex::collect(const glm::dvec3& center, double radius, ClusterList& list) const {
    bool fits = true;
    list.count = 0;
    state_->query(center, radius, [&](std::uint32_t cluster) {
        fits = list.add(cluster, state_->boxes[cluster]);
        return fits ? radius : -1.0;
    });
    return fits;
}

const glm::dvec3& ClosestPointIndex::origin() const { return state_->center; }

double ClosestPointIndex::slack(const glm::dvec3& center, double radius) const {
    return state_->slack(glm::abs(center - state_->center) + radius);
}

ClosestPoint ClosestPointIndex::closest_of(std::uint32_t triangle, const glm::dvec3& p) const {
    ClosestPoint closest = closest_on_triangle(p, shape(triangle));
    closest.triangle = triangle;
    return closest;
}

TriangleShape ClosestPointIndex::shape(std::uint32_t triangle) const {
    return state_->shape(state_->slots[triangle]);
}
const ClusteredTriangle* ClosestPointIndex::triangles() const { return state_->triangles.data(); }
const TriangleCluster* ClosestPointIndex::clusters() const { return state_->clusters.data(); }

bool ClosestPointIndex::has_plane(std::uint32_t slot) const {
    const TriangleCluster& cluster = state_->clusters[slot / TriangleCluster::size];
    return cluster.bound(slot % TriangleCluster::size).normal != glm::vec3(0.0f);
}

std::int64_t ClosestPointIndex::triangle_count() const {
    return static_cast<std::int64_t>(state_->slots.size());
}

}  // namespace astrosplat
