#include "camera/aperture.h"

#include <cmath>
#include <cstdint>

#include "core/real.h"

namespace astrosplat {
namespace {

/// i's digits to the base 2 behind the point, the last one first.
double radical_inverse(std::uint32_t i) {
    double inverse = 0.0;
    for (double digit = 0.5; i != 0; i >>= 1, digit *= 0.5)
        if (i & 1) inverse += digit;
    return inverse;
}

}  // namespace

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
