// The badge in the corner of the viewport, which says how final the picture is.
#pragma once

#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

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
