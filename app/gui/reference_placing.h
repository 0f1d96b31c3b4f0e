// The reference picture placed by hand in the view: the inside moves it, a corner scales it, the outside (or
// Shift) turns it, the wheel scales it about the mouse. In: the mouse over the view. Out: edits of the scene,
// one undo step a gesture.
#pragma once

#include "gui/gui_frame.h"
#include "scene/reference_place.h"

namespace astrosplat {

/// The view's reference is seen and being placed.
bool places_reference(const GuiFrame& frame);

class ReferencePlacing {
  public:
    /// The left button went down over the view; `frame_px` in px of the window.
    void press(const GuiFrame& frame, const FrameOnScreen& frame_px, bool turn);
    /// A frame of the mouse. Takes the wheel out of `input`.
    void read(GuiFrame& frame, const FrameOnScreen& frame_px, ViewportInput& input);

  private:
    PlaceGrip grip_ = PlaceGrip::move;
    ReferenceParams pressed_;  // as it was
    glm::dvec2 pressed_px_{0.0};
    Gesture gesture_ = 0, wheel_gesture_ = 0;
    double wheeled_at_ = -1.0;  // seconds
};

/// Its outline and corners, in px of the window.
void draw_placing(const GuiFrame& frame, const FrameOnScreen& frame_px);

}  // namespace astrosplat
