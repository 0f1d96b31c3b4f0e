#include "edit/navigate.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "camera/projection.h"
#include "core/real.h"
#include "edit/view_camera.h"

namespace astrosplat {
namespace {

constexpr double steepest_deg = 89.9;  // short of the poles, where left and right would swap
constexpr double zoom_per_step = 1.15;
constexpr double dolly_per_height = 16.0;
constexpr double nearest = 1e-9;  // scene units: the pivot never becomes the eye

double distance_of(const FreeCamera& camera) { return glm::length(camera.pivot - camera.position); }

/// A direction as its angle above the plane across `up` and the unit vector it has within that plane.
struct Elevation {
    glm::dvec3 up, level;
    double angle;  // radians

    glm::dvec3 direction() const { return level * real::cos(angle) + up * real::sin(angle); }
};

/// `above`: which way the view's up is, for a direction along `up` itself.
Elevation elevation_of(const glm::dvec3& direction, const glm::dvec3& up, const glm::dvec3& above) {
    const double sine = glm::dot(direction, up);
    glm::dvec3 level = direction - up * sine;
    if (glm::length(level) < 1e-7) level = sine > 0.0 ? -above : above;
    level = glm::normalize(level - up * glm::dot(level, up));
    return {up, level, real::asin(sine)};
}

/// Turned about `up` by the right-hand rule and raised, not beyond the poles; a steeper beginning may stay.
Elevation turned(Elevation e, double turn, double raise) {
    const double limit = std::fmax(real::radians(steepest_deg), std::fabs(e.angle));
    e.angle = std::clamp(e.angle + raise, -limit, limit);
    e.level = glm::normalize(e.level * real::cos(turn) + glm::cross(e.up, e.level) * real::sin(turn));
    return e;
}

FreeCamera scaled_about(const FreeCamera& camera, const glm::dvec3& fixed, double factor) {
    FreeCamera result = camera;
    result.pivot = fixed + (camera.pivot - fixed) * factor;
    if (has_parallel_rays(camera)) {
        result.height = std::fmax(nearest, camera.height * factor);
        result.position = result.pivot + (camera.position - camera.pivot);
        return result;
    }
    if (distance_of(camera) * factor < nearest) return camera;
    result.position = fixed + (camera.position - fixed) * factor;
    return result;
}

}  // namespace

double scene_units_per_px(const FreeCamera& camera, double viewport_height_px) {
    const Camera resolved = make_camera(camera_params(camera), viewport_height_px, viewport_height_px, {});
    const glm::dvec3 pivot(0.0, 0.0, -distance_of(camera));
    return 1.0 / exact::instance_of(make_exact_lens(resolved), pivot).px_per_unit;
}

glm::dvec3 point_under(const FreeCamera& camera, const glm::dvec2& px, const glm::dvec2& viewport_px) {
    return point_at_depth(camera, px, viewport_px, distance_of(camera));
}

glm::dvec3 point_at_depth(const FreeCamera& camera, const glm::dvec2& px, const glm::dvec2& viewport_px,
                          double depth) {
    const Camera resolved = make_camera(camera_params(camera), viewport_px.x, viewport_px.y, {});
    return resolved.eye +
           resolved.world_from_camera * exact::point_at_depth(make_exact_lens(resolved), px.x, px.y, depth);
}

FreeCamera orbit(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px) {
    const double distance = distance_of(camera), per_px = real::pi / viewport_height_px;
    const Elevation now = elevation_of((camera.position - camera.pivot) / distance, glm::normalize(camera.up),
                                       view_axes(camera).up);
    FreeCamera result = camera;
    result.position =
        camera.pivot + turned(now, -delta_px.x * per_px, delta_px.y * per_px).direction() * distance;
    return result;
}

FreeCamera look_around(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px) {
    const double per_px =
        real::radians(has_parallel_rays(camera) ? 45.0 : camera.fov_deg) / viewport_height_px;
    const ViewAxes axes = view_axes(camera);
    const Elevation now = elevation_of(axes.forward, glm::normalize(camera.up), axes.up);
    FreeCamera result = camera;
    result.pivot = camera.position +
                   turned(now, -delta_px.x * per_px, -delta_px.y * per_px).direction() * distance_of(camera);
    return result;
}

FreeCamera pan(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px) {
    const double per_px = scene_units_per_px(camera, viewport_height_px);
    return fly(camera, {-delta_px.x * per_px, delta_px.y * per_px, 0.0});
}

FreeCamera dolly(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px) {
    const double heights = (delta_px.x - delta_px.y) / viewport_height_px;
    return scaled_about(camera, camera.pivot, real::exp(-heights * real::log(dolly_per_height)));
}

FreeCamera zoom_to(const FreeCamera& camera, double steps, const glm::dvec2& px,
                   const glm::dvec2& viewport_px) {
    return scaled_about(camera, point_under(camera, px, viewport_px),
                        real::exp(-steps * real::log(zoom_per_step)));
}

FreeCamera fly(const FreeCamera& camera, const glm::dvec3& distance) {
    const ViewAxes axes = view_axes(camera);
    const glm::dvec3 way = axes.right * distance.x + axes.up * distance.y + axes.forward * distance.z;
    FreeCamera result = camera;
    result.position += way;
    result.pivot += way;
    return result;
}

FreeCamera with_pivot(const FreeCamera& camera, const glm::dvec3& point) {
    const glm::dvec3 forward = view_axes(camera).forward;
    const double depth = glm::dot(point - camera.position, forward);
    if (!(depth > nearest)) return camera;
    FreeCamera result = camera;
    result.pivot = point;
    result.position = point - forward * depth;
    return result;
}

}  // namespace astrosplat
