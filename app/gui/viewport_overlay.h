// Drawings over the frame: gate and safe areas, the camera's path, the wipe's edge, a line on the view; and
// the marks of the View menu: boxes of layers, grid and axes. In: the frame's place and the status. Out: thin
// lines in ImGui's draw list, those in depth the fainter the farther away.
#pragma once

#include <imgui.h>

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

/// A line from depth to depth over the viewport in `area`, fainter towards the far end of the scene's box.
void draw_deep_line(const GuiFrame& frame, const Rect& area, const glm::dvec3& from, const glm::dvec3& to,
                    ImU32 ink, float width);

/// Boxes of layers, grid and axes, as far as the View menu asks for them.
void draw_view_marks(const GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
