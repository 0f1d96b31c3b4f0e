// What moves the view: mouse and keys over the viewport, and the clock while the scene plays; and lines of
// the scene's camera for views beside it. In: input, the time, and the view on the screen. Out: the view's
// free camera or an edit of the document; the view's frame, and how many a second were reached; lines.
#pragma once

#include <deque>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "edit/document.h"
#include "edit/view_state.h"
#include "gui/gui.h"
#include "scene/scene.h"
#include "viewer/view_frame.h"

namespace astrosplat {

/// The frame on the screen when the hand moves.
struct ShownView {
    const ViewRequest& request;
    glm::dvec2 viewport_px;
    Bounds box;  // of the visible layers, world space
};

/// Moving in the scene's camera goes to a free copy of it, unless the camera is locked to the view: then the
/// scene's camera is edited, one undo step a gesture.
class Navigator {
  public:
    /// One frame of mouse and keyboard; `now` in seconds. True: the view left the scene's camera. Throws
    /// InputError where that cannot be edited.
    bool navigate(const ViewportInput& input, const ShownView& shown, double now, Document& document,
                  ViewState& view);

  private:
    FreeCamera moved(FreeCamera camera, const ViewportInput& input, const glm::dvec2& viewport_px,
                     const Bounds& box, double elapsed_s);

    Gesture gesture_ = 1;
    double fly_speed_ = 1.0;      // scene sizes a second
    double navigated_at_ = -1.0;  // below 0: never
};

/// Front, top and side make their camera from the layers' bounds in every frame: the free one follows, so
/// that the free view begins where the person is.
void keep_free_camera(ViewState& view, const ShownView& shown);

/// The message shown where a view left the camera.
inline constexpr const char* left_camera_message = "Free view, a copy of the camera; 0 returns to it";

/// The whole box in a free view. True: the view left the scene's camera.
bool frame_in_view(ViewState& view, const Bounds& box, const ShownView& shown);

/// The scene camera's path and its frustum, as lines in px of the viewport; lines of one point are ticks of
/// equal time along the path.
class CameraOverlay {
  public:
    using Line = std::vector<glm::vec2>;
    /// `now` is the scene at the frame; `place` shows the frame of `request`. No lines where the camera
    /// cannot be made: the frame's badge says why.
    std::vector<Line> lines(const Scene& scene, const Scene& now, const Bounds& box,
                            const ViewRequest& request, const Rect& place);

  private:
    std::vector<glm::dvec3> path_, ticks_;  // of the scene's camera
    Scene path_of_;                         // the part of the scene that it was made of, with this box
    Bounds path_box_;
};

/// Plays a scene's frames.
class Playback {
  public:
    /// Runs the frames between the view's in and out points at the scene's speed: round and round, there and
    /// back, or once. Where drawing is slower, frames are dropped, or the speed with ViewState::every_frame.
    /// With ViewState::play_final the next frame comes once this one `is_final`.
    void advance(ViewState& view, const OutputParams& output, bool is_final, double now);
    /// Frames a second that were shown over the last second or so; 0 until that is known.
    double shown_fps() const;

  private:
    double next_frame(double frame, double steps, ViewState& view, const OutputParams& output);

    double played_at_ = -1.0;      // seconds; below 0: it does not play
    bool backwards_ = false;       // on the way back
    bool waited_ = false;          // for this frame to be final
    std::deque<double> shown_at_;  // seconds of the last frames
};

}  // namespace astrosplat
