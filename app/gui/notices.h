// The status bar at the bottom: the last message, the pixel under the mouse, jobs, memory. Errors stay until
// they are clicked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gui/gui_frame.h"

namespace astrosplat {

class StatusBar {
  public:
    void draw(GuiFrame& frame, const Rect& area);

  private:
    void take_message(const Status& status);
    std::string last_;          // message seen before this frame
    std::uint64_t number_ = 0;  // of the last message
    std::string unread_;        // error that waits to be clicked
};

/// The probe's text: x, y, linear R G B A ("R", ".214") and the depth Z where there is one.
struct ProbeCell {
    const char* label;
    std::string number;
};
std::vector<ProbeCell> probe_cells(const PixelProbe& probe);

}  // namespace astrosplat
