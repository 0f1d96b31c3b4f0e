// What each view looks through, and the ways between FreeCamera and CameraParams.
#include "edit/view_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

constexpr double framing_fill = 0.9;  // share of the picture that a framed box fills, as frame_box has it

Bounds framed_box(const Bounds& box) {
    Bounds framed = box;
    if (framed.empty()) framed.add(glm::dvec3(0.0));
    if (glm::length(framed.extent()) == 0.0) {
        framed.lo -= 0.5;
        framed.hi += 0.5;
    }
    return framed;
}

/// From far enough outside that the near plane cuts nothing.
CameraParams axis_view(const glm::dvec3& back, const glm::dvec3& up, const Bounds& box, double aspect) {
    FreeCamera camera;
    camera.position = back;
    camera.pivot = glm::dvec3(0.0);
    camera.up = up;
    camera.orthographic = true;
    return camera_params(framed(camera, box, aspect));
}

/// Field of view, height and clipping of a resolved camera that sees one unit of picture height.
FreeCamera lens_of(const Camera& camera, const CameraParams& params) {
    FreeCamera free;
    free.orthographic = camera.projection == Projection::orthographic;
    if (free.orthographic)
        free.height = 1.0 / camera.focal_px;
    else
        free.fov_deg = 2.0 * real::degrees(real::atan(0.5 / camera.focal_px));
    free.near = params.near;
    free.far = params.far;
    free.near_fade = params.near_fade;
    return free;
}

}  // namespace

CameraParams camera_params(const FreeCamera& camera) {
    CameraParams params;
    params.projection = camera.orthographic ? Projection::orthographic : Projection::perspective;
    params.position = camera.position;
    params.target = camera.pivot;
    params.up = camera.up;
    params.fov = camera.fov_deg;
    params.height = camera.height;
    params.near = camera.near;
    params.far = camera.far;
    params.near_fade = camera.near_fade;
    return params;
}

CameraParams view_camera(const Scene& scene, const ViewState& view, const Bounds& box, double aspect) {
    const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    switch (view.view) {
        case ViewKind::free:
            return camera_params(view.free);
        case ViewKind::front:
            return axis_view(z, y, box, aspect);
        case ViewKind::top:
            return axis_view(y, -z, box, aspect);
        case ViewKind::side:
            return axis_view(x, y, box, aspect);
        case ViewKind::camera:
            break;
    }
    return scene_at(scene, view.frame).camera;
}

FreeCamera free_camera(const CameraParams& params, const Bounds& box, double aspect) {
    const Camera camera = make_camera(params, aspect, 1.0, box);
    const glm::dvec3 forward = -camera.world_from_camera[2];
    FreeCamera free = lens_of(camera, params);
    free.position = camera.eye;
    const glm::dvec3 middle = framed_box(box).center();
    const double least = 1e-3 * std::fmax(1e-6, glm::length(framed_box(box).extent()));
    const double distance = std::fmax(least, glm::dot(middle - camera.eye, forward));
    free.pivot = params.position && !params.rotation ? params.target : camera.eye + forward * distance;
    free.up = params.up;
    // A rolled or freely turned camera: its own up is up, or the picture would jump.
    if (glm::dot(view_axes(free).up, camera.world_from_camera[1]) < 1.0 - 1e-12)
        free.up = camera.world_from_camera[1];
    return free;
}

CameraParams moved_camera(const CameraParams& base, const FreeCamera& camera, double aspect) {
    // What differs only by rounding has not been touched.
    const auto keep_or = [](double before, double now) {
        return std::fabs(now - before) > 1e-9 * std::fabs(now) ? now : before;
    };
    CameraParams params = base;
    params.position = camera.position;
    params.target = camera.pivot;
    params.up = camera.up;
    params.roll = 0.0;
    params.rotation.reset();
    params.projection = camera.orthographic ? Projection::orthographic : Projection::perspective;
    const double tan_y = real::tan(real::radians(camera.fov_deg) * 0.5);
    if (camera.orthographic)
        params.height = keep_or(base.height, camera.height);
    else if (base.focal_length > 0.0)
        params.focal_length = keep_or(base.focal_length, 0.5 * base.film_width / (tan_y * aspect));
    else
        params.fov = keep_or(base.fov, camera.fov_deg);
    return params;
}

FreeCamera framed(const FreeCamera& camera, const Bounds& box, double aspect) {
    const Bounds whole = framed_box(box);
    const ViewAxes axes = view_axes(camera);
    const double tan_y = real::tan(real::radians(camera.fov_deg) * 0.5);
    double distance = 0.0, height = 0.0, behind = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p =
            glm::dvec3(corner & 1 ? whole.hi.x : whole.lo.x, corner & 2 ? whole.hi.y : whole.lo.y,
                       corner & 4 ? whole.hi.z : whole.lo.z) -
            whole.center();
        const double needed =
            2.0 / framing_fill *
            std::fmax(std::fabs(glm::dot(axes.right, p)) / aspect, std::fabs(glm::dot(axes.up, p)));
        height = std::fmax(height, needed);
        behind = std::fmax(behind, -glm::dot(axes.forward, p));
        distance = std::fmax(distance, 0.5 * needed / tan_y - glm::dot(axes.forward, p));
    }
    FreeCamera result = camera;
    result.pivot = whole.center();
    result.height = std::fmax(height, 1e-9);
    // Orthographic: outside the box by its own size, so that dots beyond the box are not cut.
    const double outside = 2.0 * behind + glm::length(whole.extent());
    result.position = result.pivot - axes.forward * (camera.orthographic ? outside : distance);
    return result;
}

FreeCamera three_quarter_view(const Bounds& box, double fov_deg, double aspect) {
    FreeCamera camera;
    camera.fov_deg = fov_deg;
    const Framing framing = frame_box(box, fov_deg, aspect);
    camera.position = framing.position;
    camera.pivot = framing.target;
    camera.height = framing.height;
    return camera;
}

}  // namespace astrosplat
