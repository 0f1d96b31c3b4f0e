// The window's camera: what a view looks through, and the ways between FreeCamera and CameraParams.
#pragma once

#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "core/bounds.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "scene/scene.h"

namespace astrosplat {

/// What a view looks through at a frame. `box`: the visible layers' bounds in world space, which a scene
/// camera without position and the front, top and side views frame. `aspect` = width / height of the frame.
/// Front looks along -z, side along -x, top along -y with -z up, all with parallel rays.
CameraParams view_camera(const Scene& scene, const ViewState& view, const Bounds& box, double aspect);

/// Width over height of the output's frames.
double aspect_of(const OutputParams& output);

/// What is seen in the window as the scene's camera would show it, with a place of its own. A view beside the
/// camera is as high as the viewport, or as the output's shape within it where that is the lower of the two.
/// Throws InputError where a camera without a position has nothing to frame yet.
CameraParams seen_camera(const Scene& scene, const ViewState& view, const Status& status);

/// Nothing becomes smaller with its distance: FreeCamera::height counts instead of the field of view.
bool has_parallel_rays(const FreeCamera& camera);

CameraParams camera_params(const FreeCamera& camera);
/// The free camera that shows what `params` shows; its pivot is the target, or for a camera given by a
/// rotation the point of its line of sight nearest to the box's middle. Throws InputError as make_camera
/// does.
FreeCamera free_camera(const CameraParams& params, const Bounds& box, double aspect);
/// `base` moved to where `camera` is: position and direction, and the field of view or height. Everything
/// else of `base` stays; a focal length above 0 is changed instead of the field of view.
CameraParams moved_camera(const CameraParams& base, const FreeCamera& camera, double aspect);

/// What it shows grown upwards and downwards, or cut, to `factor` times the height, at the same scale.
FreeCamera with_height(const FreeCamera& camera, double factor);
/// The whole box in the frame, seen from the same direction; the pivot is its middle.
FreeCamera framed(const FreeCamera& camera, const Bounds& box, double aspect);
/// The whole box seen diagonally from above, with the lens of `camera`.
FreeCamera three_quarter_view(const FreeCamera& camera, const Bounds& box, double aspect);

/// Unit vectors of the frame in world space.
struct ViewAxes {
    glm::dvec3 right, up, forward;
};
ViewAxes view_axes(const FreeCamera& camera);

}  // namespace astrosplat
