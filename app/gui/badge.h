// The badge in the corner of the viewport, which says how final the frame is.
#pragma once

#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

/// Also the buttons in it (Copy, Cancel). Returns where it ends, px.
float draw_badge(GuiFrame& frame, const Rect& area);

/// Beside it, from `left` on, how large the difference is that is shown, else how true the front is to its
/// picture; nothing where there is no room.
void draw_side_badge(GuiFrame& frame, const Rect& area, float left);

/// The words of the badge, for tests and drawings: "Refining 41 %" and what stands dimmed beside it.
struct BadgeText {
    std::string text, beside;
    unsigned color;  // ImU32
};
BadgeText badge_text(const Scene& scene, const Status& status);
/// "Front 39.6 dB, SSIM 0.976, light +0.3 %".
std::string front_text(const FrontStatus& front);
/// "Mean +0.4 %, 31.2 dB, light -3.0 %".
std::string difference_text(const DifferenceStatus& difference);

}  // namespace astrosplat
