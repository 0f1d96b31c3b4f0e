// Embree's scene: boxes as user geometry, and point queries whose callback may shrink their radius.
#include "generate/cluster_tree.h"

#include <embree3/rtcore.h>

#include <new>
#include <stdexcept>

#include "generate/triangle_clusters.h"

namespace astrosplat {

void ClusterTree::build(std::span<const ClusterBox> boxes) {
    device_ = rtcNewDevice("threads=1");  // keeps Embree off TBB's pool
    if (!device_) throw std::runtime_error("Embree gave no device");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);  // serial work; a better tree saves less
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
    rtcSetGeometryUserData(geometry, const_cast<ClusterBox*>(boxes.data()));  // only read
    const auto on_bounds = [](const RTCBoundsFunctionArguments* args) {
        const ClusterBox& from = static_cast<const ClusterBox*>(args->geometryUserPtr)[args->primID];
        RTCBounds& box = *args->bounds_o;
        box.lower_x = from.lo.x, box.lower_y = from.lo.y, box.lower_z = from.lo.z;
        box.upper_x = from.hi.x, box.upper_y = from.hi.y, box.upper_z = from.hi.z;
    };
    rtcSetGeometryBoundsFunction(geometry, on_bounds, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::bad_alloc();
}

ClusterTree::~ClusterTree() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
}

void ClusterTree::run(const glm::dvec3& local, double distance, double slack, const Visitor& visitor) const {
    struct Call {
        const Visitor& visitor;
        double distance, slack;
    } call{visitor, distance, slack};
    RTCPointQuery query{};
    query.x = static_cast<float>(local.x);
    query.y = static_cast<float>(local.y);
    query.z = static_cast<float>(local.z);
    query.radius = widened(distance, slack);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto on_cluster = [](RTCPointQueryFunctionArguments* args) {
        Call& c = *static_cast<Call*>(args->userPtr);
        const double left = c.visitor.visit(c.visitor.to, args->primID);
        if (left >= c.distance) return false;
        c.distance = left;
        args->query->radius = left < 0.0 ? 0.0f : widened(left, c.slack);
        return true;
    };
    rtcPointQuery(scene_, &query, &context, on_cluster, &call);
}

}  // namespace astrosplat
