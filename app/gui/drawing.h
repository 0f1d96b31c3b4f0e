// What the window draws by hand: lines and fields that cover whole pixels, and small signs, which need no
// icon font. In: places in window pixels, as they come out of a layout. Out: shapes whose borders lie between
// pixels, at every scale, so that they are sharp and look the same whatever rounds them.
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

/// A line from x0 to x1 over the pixels that `y` lies in, or from y0 to y1 over those of `x`. `width` px, at
/// least one.
void line_across(ImDrawList* list, float x0, float x1, float y, ImU32 color, float width = 1.0f);
void line_down(ImDrawList* list, float x, float y0, float y1, ImU32 color, float width = 1.0f);

/// A field, and a line of `width` px along the inside of its border; `radius` of the corners, px.
void filled(ImDrawList* list, ImVec2 lo, ImVec2 hi, ImU32 color, float radius = 0.0f);
void outlined(ImDrawList* list, ImVec2 lo, ImVec2 hi, ImU32 color, float radius = 0.0f, float width = 1.0f);
/// A square field around the pixel of `middle`, `half` px and half a pixel to either side.
void square(ImDrawList* list, ImVec2 middle, float half, ImU32 color);

/// Draws an icon in a square of `size` px around `center`.
void draw_icon(ImDrawList* list, Icon icon, ImVec2 center, float size, ImU32 color);

/// The bracket at the left of layers that are composited as one, from y0 to y1 with its back at `x`.
void draw_bracket(ImDrawList* list, float x, float y0, float y1, ImU32 color);

/// A button without a frame that shows an icon of `icon_px`, `size` px in all; a faint field when hovered.
/// `says`, its tooltip, may be nullptr. True when clicked.
bool icon_button(const char* id, Icon icon, ImVec2 size, float icon_px, ImU32 color, const char* says);

}  // namespace astrosplat
