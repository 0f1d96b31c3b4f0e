// What is drawn over the frame: gate and safe areas, the camera's path, the wipe's edge and a line on
// the view.
#pragma once

#include <cstdint>
#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

/// "16:9" where both numbers are below 30, else "2.39:1".
std::string aspect_text(std::int64_t width, std::int64_t height);

void draw_gate(const GuiFrame& frame, const Rect& area, const Rect& frame_area);
void draw_overlay_lines(const GuiFrame& frame, const Rect& area);
void draw_wipe(const GuiFrame& frame, const Rect& area, const Rect& frame_area);
void draw_view_line(const GuiFrame& frame, const Rect& area, const Rect& frame_area);

}  // namespace astrosplat
