// The eyes of a stereo pair, as cameras of their own.
#include "camera/stereo.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"

namespace astrosplat {
namespace {

/// Turned about its y axis, to the left.
glm::dmat3 turned_left(const glm::dmat3& world_from_camera, double angle) {
    const double c = real::cos(angle), s = real::sin(angle);
    const glm::dvec3 &right = world_from_camera[0], &back = world_from_camera[2];
    return {right * c - back * s, world_from_camera[1], back * c + right * s};
}

}  // namespace

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
    camera.world_from_camera =
        turned_left(camera.world_from_camera, -real::atan2(sine, std::sqrt(1.0 - sine * sine)));
}

}  // namespace astrosplat
