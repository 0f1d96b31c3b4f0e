// What is drawn over the picture: gate and safe areas, the camera's path, the wipe's edge, a line on the view
// and the badge that says how final the picture is.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

void draw_gate(const GuiFrame& frame, const Rect& area, const Rect& picture);
void draw_overlay_lines(const GuiFrame& frame, const Rect& area);
void draw_wipe(const GuiFrame& frame, const Rect& area, const Rect& picture);
void draw_view_line(const GuiFrame& frame, const Rect& area, const Rect& picture);

/// Also the buttons in it (Copy, Cancel).
void draw_badge(GuiFrame& frame, const Rect& area);

/// The words of the badge, for tests and pictures: "Refining 41 %" and what stands dimmed beside it.
struct BadgeText {
    std::string text, beside;
    unsigned color;  // ImU32
    bool warns = false;
};
BadgeText badge_text(const Scene& scene, const Status& status);

}  // namespace astrosplat
