// Where a camera has to stand to see all of a box.
#pragma once

#include "camera/camera.h"

namespace astrosplat {

/// Half the frame's height at distance 1, perspective.
double half_height(const CameraParams& params, double aspect);

/// Position and target that frame a box from 35 degrees above +z with the given vertical field of view: its
/// corners fill 90 % of the frame's width or height. An empty box counts as the origin, a point as a cube
/// of side 1.
struct Framing {
    glm::dvec3 position, target;
    double height;  // orthographic height that frames the same
};
Framing frame_box(const Bounds& box, double vertical_fov_deg, double aspect);
/// As a camera without a position looks at a box, through its own lens.
Framing frame_box(const Bounds& box, const CameraParams& params, double aspect);
/// The same seen along another direction; `world_from_camera` has the columns right, up, back.
Framing frame_box(const Bounds& box, const glm::dmat3& world_from_camera, double vertical_fov_deg,
                  double aspect);
/// The box that frame_box frames: the origin for an empty box, a cube of side 1 around a point.
Bounds box_to_frame(const Bounds& box);

}  // namespace astrosplat
