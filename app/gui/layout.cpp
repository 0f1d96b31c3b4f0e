// Places of the window's parts: sizes at content scale 1, hidden parts left out, the rest for the viewport.
#include "gui/layout.h"

#include <algorithm>
#include <cmath>

namespace astrosplat {
namespace {

constexpr float menu_height = 28, tool_height = 32, status_height = 24, notice_height = 30;
constexpr float snapshots_height = 124, timeline_closed = 36, timeline_with_graph = 240;
constexpr float smallest_viewport = 160;

// Cuts a strip off `rest` and returns it.
Rect cut_top(Rect& rest, float height) {
    height = std::min(height, rest.height);
    const Rect strip{rest.x, rest.y, rest.width, height};
    rest.y += height;
    rest.height -= height;
    return strip;
}
Rect cut_bottom(Rect& rest, float height) {
    height = std::min(height, rest.height);
    rest.height -= height;
    return {rest.x, rest.end().y, rest.width, height};
}
Rect cut_right(Rect& rest, float width) {
    width = std::min(width, rest.width);
    rest.width -= width;
    return {rest.end().x, rest.y, width, rest.height};
}

float timeline_size(const ViewState& view) {
    if (!view.panels) return 0.0f;
    if (!view.timeline_open) return timeline_closed;
    return view.graph_open ? std::max(view.timeline_height, timeline_with_graph) : view.timeline_height;
}

}  // namespace

Layout make_layout(const ViewState& view, float width_px, float height_px, float content_scale) {
    const auto scaled = [&](float length) { return std::round(length * content_scale); };
    Layout layout;
    Rect rest{0, 0, width_px, height_px};
    layout.menu = cut_top(rest, scaled(menu_height));
    layout.status = cut_bottom(rest, scaled(status_height));
    layout.panel = cut_right(rest, view.panels ? scaled(view.panel_width) : 0.0f);
    layout.tools = cut_top(rest, view.panels ? scaled(tool_height) : 0.0f);
    const bool notice = view.hint_open || view.changed_on_disk || !view.grey_layer.empty();
    layout.notice = cut_top(rest, notice ? scaled(notice_height) : 0.0f);
    const float most = std::max(rest.height - scaled(smallest_viewport), scaled(timeline_closed));
    layout.timeline = cut_bottom(rest, std::min(scaled(timeline_size(view)), view.panels ? most : 0.0f));
    layout.snapshots = cut_bottom(rest, view.panels && view.snapshots_open ? scaled(snapshots_height) : 0.0f);
    layout.viewport = rest;
    return layout;
}

Rect place_frame(const ViewState& view, const Rect& viewport, int width_px, int height_px) {
    const double w = std::max(width_px, 1), h = std::max(height_px, 1);
    double scale = view.zoom, shift_x = view.pan_px.x, shift_y = view.pan_px.y;
    if (view.size == SizeMode::fit) {
        scale = std::min(viewport.width / w, viewport.height / h);
        shift_x = shift_y = 0.0;
    }
    // Whole pixels, so that a frame of the viewport's own size is shown pixel by pixel.
    const double x = viewport.x + std::floor((viewport.width - w * scale) * 0.5 + shift_x + 0.5);
    const double y = viewport.y + std::floor((viewport.height - h * scale) * 0.5 + shift_y + 0.5);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(w * scale),
            static_cast<float>(h * scale)};
}

}  // namespace astrosplat
