// Motion blur and depth of field: cameras as an open shutter and an open aperture see them, one time and
// place after the other.
#pragma once

#include "camera/camera.h"

namespace astrosplat {

/// Whether a frame is more than one rendering: motion blur or depth of field.
inline bool is_blurred(const CameraParams& params) {
    return params.shutter > 0.0 || (params.f_number > 0.0 && params.projection == Projection::perspective);
}
/// One of the renderings that a blurred frame is the mean of.
struct CameraSample {
    double frames = 0.0;   // after the frame's own time
    glm::dvec2 lens{0.0};  // place on the aperture, in the unit disc
};
/// Number i of n: times evenly spread over the shutter's, places along a sunflower's spiral, in an order that
/// tells the one nothing of the other.
CameraSample camera_sample(const CameraParams& params, int i, int n);
/// The camera as seen through a place of the aperture (in its radii): what lies in the plane of focus, across
/// the view axis, stays where it is on the frame. `params`, which make_camera made it of, say the aperture.
Camera through_lens(const Camera& camera, const CameraParams& params, const glm::dvec2& lens,
                    double width_px);

}  // namespace astrosplat
