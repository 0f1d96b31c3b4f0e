#include "camera/framing.h"

#include <glm/geometric.hpp>

#include "core/real.h"

namespace astrosplat {
namespace {

constexpr double framing_elevation_deg = 35.0;
constexpr double framing_fill = 0.9;  // share of the frame's width or height a framed box fills

Framing frame_box_within(const Bounds& box, const glm::dmat3& world_from_camera, double tan_y,
                         double aspect) {
    const Bounds framed = box_to_frame(box);
    const glm::dvec3 &right = world_from_camera[0], &above = world_from_camera[1],
                     &back = world_from_camera[2];
    Framing framing{{}, framed.center(), 0.0};
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p = framed.corner(corner) - framing.target;
        // The frame's height that just holds this corner, at the corner's own depth.
        double height = 2.0 *
                        std::fmax(std::fabs(glm::dot(right, p)) / aspect, std::fabs(glm::dot(above, p))) /
                        framing_fill;
        framing.height = std::fmax(framing.height, height);
        distance = std::fmax(distance, glm::dot(back, p) + 0.5 * height / tan_y);
    }
    framing.position = framing.target + back * distance;
    return framing;
}

/// Where a camera without a position looks from.
glm::dmat3 framing_direction() {
    const double elevation = real::radians(framing_elevation_deg);
    const glm::dvec3 back(0.0, real::sin(elevation), real::cos(elevation));
    return {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, back.z, -back.y), back};
}

}  // namespace

double half_height(const CameraParams& params, double aspect) {
    if (params.focal_length > 0.0) return 0.5 * params.film_width / params.focal_length / aspect;
    return real::tan(real::radians(params.fov) * 0.5);
}

Framing frame_box(const Bounds& box, double vertical_fov_deg, double aspect) {
    return frame_box(box, framing_direction(), vertical_fov_deg, aspect);
}

Framing frame_box(const Bounds& box, const CameraParams& params, double aspect) {
    return frame_box_within(box, framing_direction(), half_height(params, aspect), aspect);
}

Framing frame_box(const Bounds& box, const glm::dmat3& world_from_camera, double vertical_fov_deg,
                  double aspect) {
    const double tan_y = real::tan(real::radians(vertical_fov_deg) * 0.5);
    return frame_box_within(box, world_from_camera, tan_y, aspect);
}

Bounds box_to_frame(const Bounds& box) {
    Bounds framed = box;
    if (framed.empty()) framed.add(glm::dvec3(0.0));
    if (glm::length(framed.extent()) == 0.0) {
        framed.lo -= 0.5;
        framed.hi += 0.5;
    }
    return framed;
}

}  // namespace astrosplat
