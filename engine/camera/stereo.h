// Stereo pairs. In: a camera that stands between the eyes. Out: the camera of one of them.
#pragma once

#include "camera/camera.h"

namespace astrosplat {

/// Moves a camera between the eyes to the one that `params` name. Flat frames are parallel, moved against
/// each other so that what is at the convergence distance does not move. In panoramas the eyes look out along
/// a circle around the camera and come together towards the poles, as the cosine of the latitude: then
/// distance alone says by how much longitudes differ, asin(half the separation / distance), and no footprint
/// is torn at a pole. After the turn those at the convergence distance do not differ.
void move_to_eye(Camera& camera, const CameraParams& params);

}  // namespace astrosplat
