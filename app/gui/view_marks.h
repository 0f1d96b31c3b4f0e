// Boxes of layers, grid and axes over the view: thin lines, the fainter the farther away. Only those that the
// View menu asks for.
#pragma once

#include <imgui.h>

#include "gui/gui_frame.h"

namespace astrosplat {

/// A line from depth to depth over the viewport in `area`, fainter towards the far end of the scene's box.
void draw_deep_line(const GuiFrame& frame, const Rect& area, const glm::dvec3& from, const glm::dvec3& to,
                    ImU32 ink, float width);

void draw_view_marks(const GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
