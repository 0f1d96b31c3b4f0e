// The line at the bottom: the last message, the pixel under the mouse, jobs, memory. Errors stay until they
// are clicked.
#pragma once

#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

class StatusBar {
  public:
    void draw(GuiFrame& frame, const Rect& area);

  private:
    void take_message(const Status& status);
    std::string last_;    // message seen before this frame
    std::string unread_;  // error that waits to be clicked
};

/// "x 812  y 344   R .214  G .187  B .093  A .61   Z 23.4"
std::string probe_text(const PixelProbe& probe);

}  // namespace astrosplat
