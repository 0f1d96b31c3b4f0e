// Handles in the view that move, turn and scale the selected layer, one of its crops or the camera's target.
// In: the mouse over the view. Out: edits of the scene, one undo step a drag; Escape takes the drag back.
#pragma once

#include "edit/handles.h"
#include "gui/gui_frame.h"

namespace astrosplat {

class Handles {
  public:
    /// The left button went down at a place of the viewport, px: true where that is on a handle.
    bool press(const GuiFrame& frame, const glm::dvec2& mouse_px);
    /// A frame of the mouse; `dragged`: the button that was pressed on a handle is still down.
    void read(GuiFrame& frame, const glm::dvec2& mouse_px, bool dragged);
    void draw(const GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px) const;

  private:
    HandleDrag drag_;
    Scene pressed_, pressed_at_frame_;  // the document's, and as it stood at the frame
    Camera camera_;                     // through which it was pressed
    Gesture gesture_ = 0;
};

}  // namespace astrosplat
