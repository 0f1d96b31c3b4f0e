// Where the parts of the window and the frame in it lie. In: sizes and the view. Out: rectangles.
#pragma once

#include <imgui.h>

#include <algorithm>

#include "edit/view_state.h"
#include "scene/reference_place.h"

namespace astrosplat {

/// A rectangle of the window, px from its upper left.
struct Rect {
    float x = 0, y = 0, width = 0, height = 0;

    Rect() = default;
    Rect(float x_, float y_, float width_, float height_) : x(x_), y(y_), width(width_), height(height_) {}
    Rect(ImVec2 corner, ImVec2 size) : Rect(corner.x, corner.y, size.x, size.y) {}
    ImVec2 corner() const { return {x, y}; }
    ImVec2 size() const { return {width, height}; }
    ImVec2 end() const { return {x + width, y + height}; }
    ImVec2 middle() const { return {x + width * 0.5f, y + height * 0.5f}; }
};

/// Where things lie for a window of this size. What is hidden has no height or width.
struct Layout {
    Rect menu, tools;
    Rect notice;  // one line under the tools: the hint, or that the file changed on disk
    Rect viewport;
    Rect snapshots;  // strip between viewport and timeline
    Rect panel, timeline, status;
};
Layout make_layout(const ViewState& view, float width_px, float height_px, float content_scale);

/// Where a frame of this size is shown, px of the window. Fit: as large as the viewport allows, in its
/// middle; 1:1: zoomed and moved as `view` says. It may reach beyond the viewport.
Rect place_frame(const ViewState& view, const Rect& viewport, int width_px, int height_px);

/// The same for pictures that lie over it.
inline FrameOnScreen frame_on_screen(const Rect& frame) {
    return {{frame.x + 0.5 * frame.width, frame.y + 0.5 * frame.height}, std::max(1.0f, frame.height)};
}

}  // namespace astrosplat
