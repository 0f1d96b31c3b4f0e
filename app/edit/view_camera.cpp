#include "edit/view_camera.h"

#include <glm/geometric.hpp>

#include "camera/framing.h"
#include "camera/projection.h"
#include "core/error.h"
#include "core/real.h"
#include "edit/placement.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

CameraParams axis_view(const glm::dvec3& back, const glm::dvec3& up, const Bounds& box, double aspect) {
    FreeCamera camera;
    camera.position = back;
    camera.pivot = glm::dvec3(0.0);
    camera.up = up;
    camera.projection = Projection::orthographic;
    return camera_params(framed(camera, box, aspect));
}

/// Field of view, height and clipping of a resolved camera that sees one unit of frame height.
FreeCamera lens_of(const Camera& camera, const CameraParams& params) {
    FreeCamera free;
    free.projection = camera.projection;
    if (has_parallel_rays(free))
        free.height = 1.0 / camera.focal_px;
    else if (is_onto_sphere(camera.projection))
        free.fov_deg = params.fov;
    else
        free.fov_deg = 2.0 * real::degrees(real::atan(0.5 / camera.focal_px));
    free.near = params.near;
    free.far = params.far;
    free.near_fade = params.near_fade;
    return free;
}

/// Where the camera is and which way it looks; a free camera has no roll and no rotation.
void set_place(CameraParams& params, const FreeCamera& camera) {
    params.projection = camera.projection;
    params.position = camera.position;
    params.target = camera.pivot;
    params.up = camera.up;
    params.roll = 0.0;
    params.rotation.reset();
}

}  // namespace

bool has_parallel_rays(const FreeCamera& camera) { return camera.projection == Projection::orthographic; }

ViewAxes view_axes(const FreeCamera& camera) {
    const Camera resolved = make_camera(camera_params(camera), 1.0, 1.0, {});
    return {resolved.world_from_camera[0], resolved.world_from_camera[1], view_direction(resolved)};
}

CameraParams camera_params(const FreeCamera& camera) {
    CameraParams params;
    set_place(params, camera);
    if (is_onto_sphere(camera.projection)) params.projection = Projection::perspective;
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
    CameraParams level = params;
    level.fisheye_tilt = 0.0;
    const Camera camera = make_camera(level, aspect, 1.0, box);
    const glm::dvec3 forward = view_direction(camera);
    FreeCamera free = lens_of(camera, params);
    free.position = camera.eye;
    const glm::dvec3 middle = box_to_frame(box).center();
    const double least = 1e-3 * std::fmax(1e-6, glm::length(box_to_frame(box).extent()));
    const double distance = std::fmax(least, glm::dot(middle - camera.eye, forward));
    free.pivot = params.position && !params.rotation ? params.target : camera.eye + forward * distance;
    free.up = params.up;
    // A rolled or freely turned camera: its own up is up, or the frame would jump.
    if (glm::dot(view_axes(free).up, camera.world_from_camera[1]) < 1.0 - 1e-12)
        free.up = camera.world_from_camera[1];
    return free;
}

CameraParams moved_camera(const CameraParams& base, const FreeCamera& camera, double aspect) {
    // Values that differ only by rounding have not been touched.
    const auto keep_or = [](double before, double now) {
        return std::fabs(now - before) > 1e-9 * std::fabs(now) ? now : before;
    };
    CameraParams params = base;
    set_place(params, camera);
    if (is_onto_sphere(camera.projection)) return params;
    const double tan_y = real::tan(real::radians(camera.fov_deg) * 0.5);
    if (has_parallel_rays(camera))
        params.height = keep_or(base.height, camera.height);
    else if (base.focal_length > 0.0)
        params.focal_length = keep_or(base.focal_length, 0.5 * base.film_width / (tan_y * aspect));
    else
        params.fov = keep_or(base.fov, camera.fov_deg);
    return params;
}

double aspect_of(const OutputParams& output) {
    return static_cast<double>(output.width) / static_cast<double>(output.height);
}

CameraParams seen_camera(const Scene& scene, const ViewState& view, const Status& status) {
    const Scene now = scene_at(scene, view.frame);
    const double aspect = aspect_of(now.output);
    CameraParams camera = now.camera;
    if (view.view != ViewKind::camera) {
        const double shape = status.viewport_aspect > 0.0 ? status.viewport_aspect : aspect;
        const FreeCamera free = free_camera(view_camera(scene, view, status.box, shape), status.box, shape);
        return moved_camera(camera, with_height(free, std::fmin(1.0, shape / aspect)), aspect);
    }
    if (camera.position) return camera;
    if (status.box.empty())
        throw InputError("camera.position: expected layers to frame, found none loaded yet");
    const Framing framing = frame_box(status.box, camera, aspect);
    camera.position = framing.position;
    camera.target = framing.target;
    camera.height = framing.height;
    return camera;
}

std::optional<FreeCamera> try_free_camera(const CameraParams& params, const Bounds& box, double aspect) {
    try {
        return free_camera(params, box, aspect);
    } catch (const InputError&) {
        return {};
    }
}

FreeCamera with_height(FreeCamera camera, double factor) {
    camera.height *= factor;
    camera.fov_deg = 2.0 * real::degrees(real::atan(factor * real::tan(0.5 * real::radians(camera.fov_deg))));
    return camera;
}

FreeCamera framed(FreeCamera camera, const Bounds& box, double aspect) {
    const ViewAxes axes = view_axes(camera);
    const Framing framing =
        frame_box(box, glm::dmat3(axes.right, axes.up, -axes.forward), camera.fov_deg, aspect);
    camera.pivot = framing.target;
    camera.height = std::fmax(framing.height, 1e-9);
    camera.position = framing.position;
    // From far enough outside that the near plane cuts nothing, nor splats beyond the box.
    if (has_parallel_rays(camera))
        camera.position = framing.target - axes.forward * (2.0 * glm::length(box_to_frame(box).extent()));
    return camera;
}

FreeCamera three_quarter_view(FreeCamera camera, const Bounds& box, double aspect) {
    camera.pivot = glm::dvec3(0.0);
    camera.position = glm::dvec3(1.0, 0.8, 1.0);
    camera.up = glm::dvec3(0.0, 1.0, 0.0);
    return framed(camera, box, aspect);
}

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
    return units_per_px(make_camera(camera_params(camera), viewport_height_px, viewport_height_px, {}),
                        camera.pivot);
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

FreeCamera orbit(FreeCamera camera, const glm::dvec2& delta_px, double viewport_height_px) {
    const double distance = distance_of(camera), per_px = real::pi / viewport_height_px;
    const Elevation now = elevation_of((camera.position - camera.pivot) / distance, glm::normalize(camera.up),
                                       view_axes(camera).up);
    camera.position =
        camera.pivot + turned(now, -delta_px.x * per_px, delta_px.y * per_px).direction() * distance;
    return camera;
}

FreeCamera look_around(FreeCamera camera, const glm::dvec2& delta_px, double viewport_height_px) {
    const double per_px =
        real::radians(has_parallel_rays(camera) ? 45.0 : camera.fov_deg) / viewport_height_px;
    const ViewAxes axes = view_axes(camera);
    const Elevation now = elevation_of(axes.forward, glm::normalize(camera.up), axes.up);
    camera.pivot = camera.position +
                   turned(now, -delta_px.x * per_px, -delta_px.y * per_px).direction() * distance_of(camera);
    return camera;
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

FreeCamera fly(FreeCamera camera, const glm::dvec3& distance) {
    const ViewAxes axes = view_axes(camera);
    const glm::dvec3 way = axes.right * distance.x + axes.up * distance.y + axes.forward * distance.z;
    camera.position += way;
    camera.pivot += way;
    return camera;
}

FreeCamera with_pivot(FreeCamera camera, const glm::dvec3& point) {
    const glm::dvec3 forward = view_axes(camera).forward;
    const double depth = glm::dot(point - camera.position, forward);
    if (!(depth > nearest)) return camera;
    camera.pivot = point;
    camera.position = point - forward * depth;
    return camera;
}

}  // namespace astrosplat
