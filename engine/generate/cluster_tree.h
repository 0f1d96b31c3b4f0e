// Embree's bounding volumes over the boxes of clusters. In: boxes, then points. Out: the clusters near a
// point. Embree works in float: every radius is widened by more than its roundings can amount to.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "generate/candidates.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace astrosplat {

class ClusterTree {
  public:
    ClusterTree() = default;
    ~ClusterTree();
    ClusterTree(const ClusterTree&) = delete;
    ClusterTree& operator=(const ClusterTree&) = delete;

    /// Once, on one thread. Refers to `boxes`. Throws std::bad_alloc or std::runtime_error where Embree gives
    /// up.
    void build(std::span<const ClusterBox> boxes);

    /// `visit(cluster number)` is called for at least every cluster whose box is within `distance` of
    /// `local`, give or take `slack`; it returns the distance that still matters, which may only shrink, or a
    /// negative number to stop. Thread-safe.
    template <class Visit>
    void query(const glm::dvec3& local, double distance, double slack, Visit visit) const {
        const auto call = [](void* to, std::uint32_t cluster) { return (*static_cast<Visit*>(to))(cluster); };
        run(local, distance, slack, {call, &visit});
    }

  private:
    struct Visitor {
        double (*visit)(void* to, std::uint32_t cluster);
        void* to;
    };
    void run(const glm::dvec3& local, double distance, double slack, const Visitor& visitor) const;

    RTCDeviceTy* device_ = nullptr;
    RTCSceneTy* scene_ = nullptr;
};

}  // namespace astrosplat
