// Mouse and keys over the viewport become a camera (VIEWER.md). Moving in the scene's camera goes to a free
// copy of it, unless the camera is locked to the view: then the scene's camera is edited, one undo step a
// gesture. In: what the hand did and what it saw. Out: the view's free camera, or an edit of the document.
#pragma once

#include <glm/vec2.hpp>

#include "edit/document.h"
#include "edit/view_state.h"
#include "gui/gui.h"
#include "viewer/view_frame.h"

namespace astrosplat {

/// What is on the screen when the hand moves.
struct ShownView {
    const ViewRequest& request;
    glm::dvec2 viewport_px;
    Bounds box;  // of the visible layers, world space
};

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

/// What the person is told where a view left the camera.
inline constexpr const char* left_camera_message = "Free view, a copy of the camera; 0 returns to it";

/// The whole box in a free view. True: the view left the scene's camera.
bool frame_in_view(ViewState& view, const Bounds& box, const ShownView& shown);

}  // namespace astrosplat
