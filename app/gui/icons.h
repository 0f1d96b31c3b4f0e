// Small signs drawn with lines, so that they are sharp at every scale and need no icon font.
#pragma once

#include <imgui.h>

namespace astrosplat {

enum class Icon {
    eye,
    eye_closed,
    diamond,        // a keyframe is here
    diamond_empty,  // animated, no keyframe here; or can be
    play,
    pause,
    chevron_right,
    chevron_down,
    chevron_up,
    plus,
    cross,
    ring,      // holdout off
    ring_cut,  // holdout on
    curve,
    warning,
    folder,
    file,
    dots
};

/// Draws an icon in a square of `size` px around `center`.
void draw_icon(ImDrawList* list, Icon icon, ImVec2 center, float size, ImU32 color);

/// The bracket at the left of layers that are composited as one, from y0 to y1 with its back at `x`.
void draw_bracket(ImDrawList* list, float x, float y0, float y1, ImU32 color);

/// A button without a frame that shows an icon of `icon_px`, `size` px in all; a faint field when hovered.
/// `says`, its tooltip, may be nullptr. True when clicked.
bool icon_button(const char* id, Icon icon, ImVec2 size, float icon_px, ImU32 color, const char* says);

}  // namespace astrosplat
