#include "edit/project_line.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "camera/projection.h"

namespace astrosplat {
namespace {

glm::vec2 to_px(const Camera& camera, const glm::dvec3& in_camera) {
    const exact::Instance at = exact::instance_of(make_exact_lens(camera), in_camera);
    return {static_cast<float>(at.x_px), static_cast<float>(at.y_px)};
}

glm::dvec3 in_camera(const Camera& camera, const glm::dvec3& point) {
    return glm::transpose(camera.world_from_camera) * (point - camera.eye);
}

/// Points of camera space up to here are seen.
double front_of(const Camera& camera) {
    const bool all = exact::has_parallel_rays(make_exact_lens(camera)) || is_onto_sphere(camera.projection);
    return all ? 1e300 : -std::max(1e-6, camera.near);
}

/// A line between the two goes round what lies behind a fisheye or across a panorama's seam.
bool is_torn(const Camera& camera, const glm::vec2& from, const glm::vec2& to) {
    return is_onto_sphere(camera.projection) && glm::distance(from, to) > 2.0f * float(camera.focal_px);
}

}  // namespace

Camera camera_on_screen(const Camera& camera, const glm::dvec2& corner, double scale) {
    Camera shown = camera;
    shown.focal_px *= scale;
    shown.center_x_px = corner.x + scale * camera.center_x_px;
    shown.center_y_px = corner.y + scale * camera.center_y_px;
    return shown;
}

double view_depth(const Camera& camera, const glm::dvec3& point) {
    const glm::dvec3 p = in_camera(camera, point);
    return is_onto_sphere(camera.projection) ? glm::length(p) : -p.z;
}

std::optional<glm::vec2> project_point(const Camera& camera, const glm::dvec3& point) {
    const glm::dvec3 p = in_camera(camera, point);
    if (p.z > front_of(camera)) return std::nullopt;
    return to_px(camera, p);
}

std::vector<std::vector<glm::vec2>> project_line(const Camera& camera, const std::vector<glm::dvec3>& line) {
    const double front = front_of(camera);
    std::vector<std::vector<glm::vec2>> parts;
    bool open = false;
    glm::dvec3 before(0.0);
    for (std::size_t i = 0; i < line.size(); ++i) {
        const glm::dvec3 p = in_camera(camera, line[i]);
        const bool seen = p.z <= front;
        if (i > 0 && seen != (before.z <= front)) {
            const glm::dvec3 cut = before + (p - before) * ((front - before.z) / (p.z - before.z));
            if (!open) parts.emplace_back();
            parts.back().push_back(to_px(camera, cut));
            open = seen;
        }
        if (seen) {
            const glm::vec2 px = to_px(camera, p);
            if (!open || is_torn(camera, parts.back().back(), px)) parts.emplace_back();
            open = true;
            parts.back().push_back(px);
        }
        before = p;
    }
    return parts;
}

ViewRay ray_through(const Camera& camera, const glm::dvec2& px) {
    const ExactLens lens = make_exact_lens(camera);
    const glm::dvec3 direction =
        glm::normalize(camera.world_from_camera * exact::ray_through(lens, px.x, px.y));
    const glm::dvec3 begin =
        exact::has_parallel_rays(lens) ? exact::point_at_depth(lens, px.x, px.y, 0.0) : glm::dvec3(0.0);
    return {camera.eye + camera.world_from_camera * begin, direction};
}

double units_per_px(const Camera& camera, const glm::dvec3& point) {
    const bool parallel = exact::has_parallel_rays(make_exact_lens(camera));
    return (parallel ? 1.0 : std::max(1e-9, view_depth(camera, point))) / camera.focal_px;
}

}  // namespace astrosplat
