// The frame and what belongs to it: gate, badge, wipe handle, and the mouse over it. In: the frame's
// texture and how far it is. Out: ViewportInput for the viewer's camera.
#pragma once

#include "gui/gui_frame.h"
#include "gui/handles.h"
#include "gui/path_points.h"
#include "gui/reference_placing.h"

namespace astrosplat {

class Viewport {
  public:
    void draw(GuiFrame& frame, const Rect& area);
    const ViewportInput& input() const { return input_; }

  private:
    void read_mouse(GuiFrame& frame, const Rect& area, const Rect& frame_area);
    void begin_drag(GuiFrame& frame, const Rect& area, const Rect& frame_area);
    void move_frame(GuiFrame& frame, const Rect& area);
    void read_click();

    ViewportInput input_;
    ReferencePlacing placing_;
    Handles handles_;
    PathPoints path_points_;
    int button_ = -1;              // that began the drag
    bool moves_frame_ = false;     // 1:1: a pan stays in the window
    bool may_click_ = false;       // the button that is down began nothing else
    glm::dvec2 clicked_px_{-1e9};  // where the last click was
};

/// Which drag a press of this mouse button (ImGuiMouseButton) begins.
ViewportInput::Drag drag_of(int button, bool shift, bool alt);

}  // namespace astrosplat
