// The cameras of views: FreeCamera from and to CameraParams, and navigation as pure functions. Pixels are the
// viewport's, y down; angles are so that the point under the mouse follows it. And keyframes of the camera:
// what is seen, and whole moves, as rows of the scene's tracks.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "core/bounds.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "scene/scene.h"

namespace astrosplat {

/// The camera of a view at a frame. `box`: the visible layers' bounds in world space, which a scene
/// camera without position and the front, top and side views frame. `aspect` = width / height of the frame.
/// Front looks along -z, side along -x, top along -y with -z up, all with parallel rays.
CameraParams view_camera(const Scene& scene, const ViewState& view, const Bounds& box, double aspect);

/// Width over height of the output's frames.
double aspect_of(const OutputParams& output);

/// The view in the window as a camera of the scene, with a place of its own. A view other than the camera's
/// is as high as the viewport, or as the output's shape within it where that is the lower of the two. Throws
/// InputError where a camera without a position has nothing to frame yet.
CameraParams seen_camera(const Scene& scene, const ViewState& view, const Status& status);

/// Nothing becomes smaller with its distance: FreeCamera::height counts instead of the field of view.
bool has_parallel_rays(const FreeCamera& camera);

CameraParams camera_params(const FreeCamera& camera);
/// The free camera that shows what `params` shows; its pivot is the target, or for a camera given by a
/// rotation the point of its line of sight nearest to the box's middle.
/// Throws InputError as make_camera does.
FreeCamera free_camera(const CameraParams& params, const Bounds& box, double aspect);
/// The same; none where it throws.
std::optional<FreeCamera> try_free_camera(const CameraParams& params, const Bounds& box, double aspect);
/// `base` moved to where `camera` is: position and direction, and the field of view or height. Everything
/// else of `base` stays; a focal length above 0 is changed instead of the field of view.
CameraParams moved_camera(const CameraParams& base, const FreeCamera& camera, double aspect);

/// Its view grown upwards and downwards, or cut, to `factor` times the height, at the same scale.
FreeCamera with_height(FreeCamera camera, double factor);
/// The whole box in the frame, seen from the same direction; the pivot is its middle.
FreeCamera framed(FreeCamera camera, const Bounds& box, double aspect);
/// The whole box seen diagonally from above, with the lens of `camera`.
FreeCamera three_quarter_view(FreeCamera camera, const Bounds& box, double aspect);

/// Unit vectors of the frame in world space.
struct ViewAxes {
    glm::dvec3 right, up, forward;
};
ViewAxes view_axes(const FreeCamera& camera);

/// Scene units a pixel covers in the plane through the pivot.
double scene_units_per_px(const FreeCamera& camera, double viewport_height_px);
/// The point of the plane through the pivot that lies under a pixel.
glm::dvec3 point_under(const FreeCamera& camera, const glm::dvec2& px, const glm::dvec2& viewport_px);
/// The point under a pixel at a depth along the line of sight (RenderedFrame's Z).
glm::dvec3 point_at_depth(const FreeCamera& camera, const glm::dvec2& px, const glm::dvec2& viewport_px,
                          double depth);

/// Around the pivot like a turntable: half a turn per viewport height, never over the poles.
FreeCamera orbit(FreeCamera camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Sideways, so that the plane through the pivot moves with the mouse.
FreeCamera pan(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Towards the pivot (dragging up or right): a viewport height is a factor of 16 in distance.
FreeCamera dolly(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Nearer by a factor of 1.15 a step; the point of the pivot's plane under the mouse stays there.
FreeCamera zoom_to(const FreeCamera& camera, double steps, const glm::dvec2& px,
                   const glm::dvec2& viewport_px);
/// Turns the camera where it stands, one field of view per viewport height.
FreeCamera look_around(FreeCamera camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Moves camera and pivot by scene units to the right, up and forward.
FreeCamera fly(FreeCamera camera, const glm::dvec3& distance);
/// Moves sideways until `point` is in the middle; it is the pivot then. A point behind the camera
/// is not taken.
FreeCamera with_pivot(FreeCamera camera, const glm::dvec3& point);

/// Sets keyframes of position, target and whatever else of the camera is animated at `frame` to those of
/// `camera`. The first keyframe of a camera that did not move takes its lens and its up as well: there is no
/// other time at which they could be wrong.
void set_camera_keyframe(Scene& scene, const CameraParams& camera, double frame);

/// "Key camera here": sets those of seen_camera at the view's frame, rounded.
/// Throws as that does.
void set_keyframe_of_seen_camera(Scene& scene, const ViewState& view, const Status& status);

inline constexpr std::array<const char*, 3> camera_move_names{"Orbit", "Fly in", "Face-on to edge-on"};
/// Ten seconds of an eased move, beginning at `frame`, around what the camera looks at, or the middle of
/// `box` (the visible layers' bounds in world space) where it looks elsewhere. An orbit goes around the
/// camera's up. Takes the place of the camera's position and target over that time, from face-on to edge-on
/// of its up, too, where that has to turn, and lets [output] frames reach to its end.
void add_camera_move(Scene& scene, CameraMove move, const Bounds& box, double frame,
                     LaterKeys later = LaterKeys::keep);
/// How many frames after `frame` have keyframes of the camera.
std::size_t camera_keyframes_after(const Scene& scene, double frame);

}  // namespace astrosplat
