// Motion blur and depth of field: a blurred frame is the mean of several renderings, each with the camera at
// one moment of the open shutter and one place of the open aperture.
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
/// Sample i of n: moments evenly spread over the open shutter, places on a sunflower's (Vogel's) spiral over
/// the aperture, in an order that does not depend on the moments.
CameraSample camera_sample(const CameraParams& params, int i, int n);
/// The camera moved to a place of the aperture (unit disc) and shifted so that the plane of focus, which lies
/// across the view axis, stays where it is on the frame. `params` are those that make_camera made `camera`
/// of.
Camera through_lens(const Camera& camera, const CameraParams& params, const glm::dvec2& lens,
                    double width_px);

}  // namespace astrosplat
