// Drawings over the frame: gate and safe areas, the camera's path, the wipe's edge, a line on the view; the
// marks of the View menu: boxes of layers, grid and axes, a scale bar; and the badge in the corner, which
// says how final the frame is. In: the frame's place and the status. Out: thin lines in ImGui's draw list,
// those in depth the fainter the farther away, and words.
#pragma once

#include <imgui.h>

#include "gui/gui_frame.h"

namespace astrosplat {

/// "16:9" where both numbers are below 30, else "2.39:1".
std::string aspect_text(std::int64_t width, std::int64_t height);

void draw_gate(const GuiFrame& frame, const Rect& area, const Rect& frame_area);
void draw_overlay_lines(const GuiFrame& frame, const Rect& area);
void draw_wipe(const GuiFrame& frame, const Rect& area, const Rect& frame_area);
/// Status::scopes with their scales, as far as the View menu asks for them, along the lower edge.
void draw_scopes(const GuiFrame& frame, const Rect& area);
void draw_view_line(const GuiFrame& frame, const Rect& area, const Rect& frame_area);
/// The length of a round number of light years where the view looks at, as far as the View menu asks for it.
void draw_scale_bar(const GuiFrame& frame, const Rect& area, const Rect& frame_area);

/// A line from depth to depth over the viewport in `area`, fainter towards the far end of the scene's box.
void draw_deep_line(const GuiFrame& frame, const Rect& area, const glm::dvec3& from, const glm::dvec3& to,
                    ImU32 ink, float width);

/// Boxes of layers, grid and axes, as far as the View menu asks for them.
void draw_view_marks(const GuiFrame& frame, const Rect& area);

// The badge (badge.cpp).

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
/// "Matches the picture", "Front changed by look: gain".
std::string front_text(const FrontStatus& front);
/// "Front 39.6 dB, SSIM 0.976, light +0.3 %".
std::string front_figures(const FrontStatus& front);
/// "Mean +0.4 %, 31.2 dB, light -3.0 %".
std::string difference_text(const DifferenceStatus& difference);

}  // namespace astrosplat
