// USD as text: an animated UsdGeomCamera for Houdini, Blender, Omniverse and their like.
#pragma once

#include <string>

#include "camera_files/camera_track.h"

namespace astrosplat {

/// What a camera in USD has beside its samples.
struct UsdLens {
    double aspect = 1.0;            // width / height
    double near = 0.01, far = 0.0;  // scene units; far 0: none
};

/// A stage with one camera, y up, whose transform, focal length (24 mm of film from bottom to top, as tenths
/// of scene units) or apertures have a time sample at every frame.
std::string usda_text(const CameraTrack& track, const UsdLens& lens);

}  // namespace astrosplat
