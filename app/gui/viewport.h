// The picture and what belongs to it: gate, badge, wipe handle, and the mouse over it. In: the picture's
// texture and how far it is. Out: ViewportInput for the viewer's camera.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

class Viewport {
  public:
    void draw(GuiFrame& frame, const Rect& area);
    const ViewportInput& input() const { return input_; }

  private:
    void read_mouse(GuiFrame& frame, const Rect& area, const Rect& picture);
    void begin_drag(GuiFrame& frame, const Rect& picture);
    void move_picture(GuiFrame& frame, const Rect& area);

    ViewportInput input_;
    int button_ = -1;             // that began the drag
    bool moves_picture_ = false;  // 1:1: a pan stays in the window
};

/// Which drag a press of this mouse button (ImGuiMouseButton) begins.
ViewportInput::Drag drag_of(int button, bool shift, bool alt);

}  // namespace astrosplat
