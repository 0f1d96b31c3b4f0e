// Keyframes of the camera: what is seen, and whole moves, as rows of them. In: a scene and a camera or a box.
// Out: the scene's tracks.
#pragma once

#include <array>
#include <cstddef>

#include "core/bounds.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "scene/scene.h"

namespace astrosplat {

/// Sets keyframes of position, target and whatever else of the camera is animated at `frame` to those of
/// `camera`. The first keyframe of a camera that did not move takes its lens and its up as well: there is no
/// other time at which they could be wrong.
void set_camera_keyframe(Scene& scene, const CameraParams& camera, double frame);

/// "Key camera here": sets those of seen_camera (view_camera.h) at the view's frame, rounded. Throws as that
/// does.
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
