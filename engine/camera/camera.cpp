// CameraParams -> Camera: the axes from target, up and roll or from a quaternion, and the focal length in
// pixels. Everything in double, with the engine's own trigonometry.
#include "camera/camera.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "camera/framing.h"
#include "camera/projection.h"
#include "core/error.h"
#include "core/real.h"
#include "core/rotation.h"

namespace astrosplat {
namespace {

/// Turns two orthogonal axes in their plane: `a` away from `b`, which follows.
void turn(glm::dvec3& a, glm::dvec3& b, double radians) {
    const double c = real::cos(radians), s = real::sin(radians);
    const glm::dvec3 before = a;
    a = a * c - b * s;
    b = b * c + before * s;
}

/// Moves a camera between the eyes to the one that `params` name. Flat frames are parallel, moved against
/// each other so that what is at the convergence distance does not move. In panoramas the eyes look out along
/// a circle around the camera and come together towards the poles, as the cosine of the latitude: then
/// distance alone says by how much longitudes differ, asin(half the separation / distance), and no footprint
/// is torn at a pole. After the turn those at the convergence distance do not differ.
void move_to_eye(Camera& camera, const CameraParams& params) {
    if (params.eye == Eye::centre || !has_two_eyes(params.projection)) return;
    const double wanted = params.convergence > 0.0 ? params.convergence : camera.target_distance;
    const double meeting = std::fmax(wanted, camera.near);
    const double to_right = 0.5 * params.eye_separation * (params.eye == Eye::right ? 1.0 : -1.0);
    if (params.projection == Projection::perspective) {
        camera.eye += to_right * camera.world_from_camera[0];
        camera.center_x_px += camera.focal_px * to_right / meeting;
        return;
    }
    const double sine = std::fmin(std::fmax(-to_right / meeting, -1.0), 1.0);
    camera.parallax = -to_right;
    glm::dmat3& axes = camera.world_from_camera;
    turn(axes[0], axes[2], -real::atan2(sine, std::sqrt(1.0 - sine * sine)));
}

constexpr double parallel_sine = 1e-9;  // below this sine two directions count as parallel

void expect(bool good, const char* key, const char* expected, double found) {
    if (!good) throw InputError(fmt::format("{}: expected {}, found {}", key, expected, found));
}

// The negated comparisons of `expect` refuse NaN as well.
void check(const CameraParams& params) {
    if (params.projection == Projection::orthographic) {
        expect(params.height > 0.0, "camera.height", "more than 0 scene units", params.height);
    } else {
        expect(params.near > 0.0, "camera.near", "more than 0 scene units", params.near);
        expect(params.fov > 0.0 && params.fov < 180.0, "camera.fov", "degrees between 0 and 180", params.fov);
        expect(params.focal_length >= 0.0, "camera.focal_length", "0 or more mm", params.focal_length);
        expect(params.film_width > 0.0, "camera.film_width", "more than 0 mm", params.film_width);
    }
    if (params.projection == Projection::fisheye)
        expect(params.fisheye_fov > 0.0 && params.fisheye_fov <= 360.0, "camera.fisheye_fov",
               "degrees above 0, at most 360", params.fisheye_fov);
    expect(params.panorama_fov > 0.0 && params.panorama_fov <= 360.0, "camera.panorama_fov",
           "degrees above 0, at most 360", params.panorama_fov);
    expect(params.shutter >= 0.0 && params.shutter <= 720.0, "camera.shutter", "degrees from 0 to 720",
           params.shutter);
    expect(params.f_number >= 0.0, "camera.f_number", "0 or more", params.f_number);
    expect(params.eye_separation >= 0.0, "camera.eye_separation", "0 or more scene units",
           params.eye_separation);
    expect(params.convergence >= 0.0, "camera.convergence", "0 or more scene units", params.convergence);
    expect(params.unit_mm > 0.0, "camera.unit_mm", "more than 0 mm", params.unit_mm);
    expect(params.far == 0.0 || params.far > params.near, "camera.far", "0, or more than camera.near",
           params.far);
}

bool parallel(const glm::dvec3& a, const glm::dvec3& b) {
    return !(glm::length(glm::cross(a, b)) > parallel_sine * glm::length(a) * glm::length(b));
}

// Columns x right, y up, z backwards; roll turns x and y about the viewing direction.
glm::dmat3 look_along(const glm::dvec3& view, glm::dvec3 up, double roll_deg) {
    if (parallel(view, up)) up = glm::dvec3(0.0, 0.0, -1.0);
    if (parallel(view, up)) up = glm::dvec3(1.0, 0.0, 0.0);
    glm::dvec3 back = -glm::normalize(view);
    glm::dvec3 right = glm::normalize(glm::cross(up, back));
    glm::dvec3 above = glm::cross(back, right);
    turn(right, above, real::radians(roll_deg));
    return glm::dmat3(right, above, back);
}

glm::dmat3 orientation(const CameraParams& params, const glm::dvec3& position, const glm::dvec3& target) {
    if (params.rotation) return rotation_from_quaternion(*params.rotation);
    glm::dvec3 view = target - position;
    if (!(glm::length(view) > 0.0))
        throw InputError(
            fmt::format("camera.target: expected a point other than camera.position, found [{}, {}, {}]",
                        target.x, target.y, target.z));
    if (!(glm::length(params.up) > 0.0)) throw InputError("camera.up: expected a direction, found [0, 0, 0]");
    return look_along(view, params.up, params.roll);
}

template <class AnyLens>
AnyLens lens_of(const Camera& camera) {
    static_assert(numbered_as<Projection>(shared::PROJECTION_PERSPECTIVE, shared::PROJECTION_ORTHOGRAPHIC,
                                          shared::PROJECTION_FISHEYE, shared::PROJECTION_EQUIRECTANGULAR,
                                          shared::PROJECTION_CYLINDRICAL));
    using Number = decltype(AnyLens::near);
    return {int(camera.projection),
            static_cast<Number>(camera.focal_px),
            static_cast<Number>(camera.center_x_px),
            static_cast<Number>(camera.center_y_px),
            static_cast<Number>(camera.near),
            static_cast<Number>(camera.far),
            static_cast<Number>(camera.near_fade),
            static_cast<Number>(camera.edge),
            static_cast<Number>(camera.parallax)};
}

/// i's digits to the base 2 behind the point, the last one first.
double radical_inverse(std::uint32_t i) {
    double inverse = 0.0;
    for (double digit = 0.5; i != 0; i >>= 1, digit *= 0.5)
        if (i & 1) inverse += digit;
    return inverse;
}

}  // namespace

Camera make_camera(const CameraParams& params, double width_px, double height_px, const Bounds& scene_box) {
    check(params);
    Camera camera;
    camera.projection = params.projection;
    camera.aspect = width_px / height_px;
    double tan_y = half_height(params, camera.aspect);
    double height = params.height;
    glm::dvec3 target = params.target;
    if (params.position) {
        camera.eye = *params.position;
    } else {
        const Framing framing = frame_box(scene_box, params, camera.aspect);
        camera.eye = framing.position;
        target = framing.target;
        height = framing.height;
    }
    camera.world_from_camera = orientation(params, camera.eye, target);
    camera.center_x_px = 0.5 * width_px;
    camera.center_y_px = 0.5 * height_px;
    switch (params.projection) {
        case Projection::perspective:
            camera.focal_px = 0.5 * height_px / tan_y;
            camera.center_x_px -= params.shift.x * width_px;
            camera.center_y_px += params.shift.y * height_px;
            break;
        case Projection::orthographic:
            camera.focal_px = height_px / height;
            break;
        case Projection::fisheye:
            camera.edge = 0.5 * real::radians(params.fisheye_fov);
            camera.focal_px = 0.5 * std::fmin(width_px, height_px) / camera.edge;
            if (params.fisheye_tilt != 0.0)  // looks higher
                turn(camera.world_from_camera[2], camera.world_from_camera[1],
                     real::radians(params.fisheye_tilt));
            break;
        case Projection::equirectangular:
        case Projection::cylindrical:
            camera.edge = 0.5 * real::radians(params.panorama_fov);
            camera.focal_px = 0.5 * width_px / camera.edge;
            break;
    }
    camera.near = params.near;
    camera.far = params.far;
    camera.near_fade = params.near_fade;
    camera.target_distance = params.rotation ? glm::length(target - camera.eye)
                                             : glm::dot(view_direction(camera), target - camera.eye);
    move_to_eye(camera, params);
    return camera;
}

Lens make_lens(const Camera& camera) { return lens_of<Lens>(camera); }
ExactLens make_exact_lens(const Camera& camera) { return lens_of<ExactLens>(camera); }

glm::dvec3 direction_to(const Camera& camera, const glm::dvec3& place) {
    const glm::dvec3 ray = place - camera.eye;
    const double length = glm::length(ray);
    const bool parallel = camera.projection == Projection::orthographic || !(length > 0.0);
    return parallel ? view_direction(camera) : ray / length;
}

bool shows(const Camera& camera, double x_px, double y_px) {
    return exact::shows(make_exact_lens(camera), x_px, y_px);
}

glm::dvec3 ray_direction(const Camera& camera, double x_px, double y_px) {
    const ExactLens lens = make_exact_lens(camera);
    const glm::dvec3 ray = camera.world_from_camera * exact::ray_through(lens, x_px, y_px);
    return exact::has_parallel_rays(lens) ? ray : glm::normalize(ray);
}

double pixel_spread(const Camera& camera) { return exact::pixel_spread(make_exact_lens(camera)); }

// OpenEXR's camera space is left-handed, z forward; its NDC has (0, 0) at the display window's upper left
// corner and (1, 1) at the lower right one (OpenEXR, Standard Attributes: worldToCamera, worldToNDC).
ExrMatrices exr_matrices(const Camera& camera, double width_px, double height_px) {
    std::array<glm::dvec3, 3> axes = {camera.world_from_camera[0], camera.world_from_camera[1],
                                      -camera.world_from_camera[2]};
    std::array<glm::dvec4, 4> column;  // of world_to_camera: coordinate = dot(column, (p, 1))
    for (std::size_t i = 0; i < 3; ++i) column[i] = glm::dvec4(axes[i], -glm::dot(axes[i], camera.eye));
    column[3] = glm::dvec4(0.0, 0.0, 0.0, 1.0);

    const bool parallel_rays = exact::has_parallel_rays(make_exact_lens(camera));
    double depth_scale = camera.far > 0.0 ? 1.0 / (camera.far - camera.near) : 1.0;
    if (!parallel_rays && camera.far > 0.0) depth_scale *= camera.far;
    const glm::dvec4& w = parallel_rays ? column[3] : column[2];
    std::array<glm::dvec4, 4> ndc = {
        (column[0] * camera.focal_px + w * camera.center_x_px) / width_px,
        (column[1] * -camera.focal_px + w * camera.center_y_px) / height_px,
        (column[2] - column[3] * camera.near) * depth_scale,  // 0 at near, 1 at far; readers discard it
        w,
    };
    ExrMatrices result{};
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) {
            result.world_to_camera[4 * r + c] = float(column[c][r]);
            result.world_to_ndc[4 * r + c] = float(ndc[c][r]);
        }
    return result;
}

glm::dmat3 rotation_from_quaternion(const glm::dvec4& q) {
    double length = glm::length(q);
    if (!(length > 0.0))
        throw InputError(fmt::format(
            "camera.rotation: expected a quaternion x y z w that is not zero, found [{}, {}, {}, {}]", q.x,
            q.y, q.z, q.w));
    return matrix_of_quaternion(q / length);
}

CameraSample camera_sample(const CameraParams& params, int i, int n) {
    // The places go outwards; times are in the radical inverse's order, which does not.
    int earlier = 0;
    for (int k = 0; k < n; ++k)
        earlier += radical_inverse(std::uint32_t(k)) < radical_inverse(std::uint32_t(i)) ? 1 : 0;
    constexpr double golden_angle = 2.39996322972865332;
    const double r = std::sqrt((i + 0.5) / n), turn = golden_angle * i;
    return {params.shutter / 360.0 * ((earlier + 0.5) / n - 0.5), {r * real::cos(turn), r * real::sin(turn)}};
}

Camera through_lens(const Camera& camera, const CameraParams& params, const glm::dvec2& lens,
                    double width_px) {
    if (!(params.f_number > 0.0) || camera.projection != Projection::perspective) return camera;
    const double focal_mm = camera.focal_px / width_px * params.film_width;
    const double radius = 0.5 * focal_mm / params.f_number / params.unit_mm;
    const double wanted = params.focus_distance > 0.0 ? params.focus_distance : camera.target_distance;
    const double focus = std::fmax(wanted, camera.near);
    Camera seen = camera;
    seen.eye += radius * (lens.x * camera.world_from_camera[0] + lens.y * camera.world_from_camera[1]);
    seen.center_x_px += camera.focal_px * radius * lens.x / focus;
    seen.center_y_px -= camera.focal_px * radius * lens.y / focus;
    return seen;
}

}  // namespace astrosplat
