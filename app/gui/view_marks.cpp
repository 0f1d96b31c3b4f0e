#include "gui/view_marks.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "edit/placement.h"
#include "gui/theme.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

constexpr float grid_width = 1.0f, box_width = 1.2f, axis_width = 1.6f;  // px at scale 1

/// Depths between which lines fade.
struct DepthRange {
    double near, far;
};

DepthRange depth_range(const Camera& camera, const Bounds& box) {
    const Bounds framed = box_to_frame(box);
    DepthRange range{1e300, -1e300};
    for (int corner = 0; corner < 8; ++corner) {
        const double depth = view_depth(camera, framed.corner(corner));
        range = {std::min(range.near, depth), std::max(range.far, depth)};
    }
    return range;
}

float opacity_at(const DepthRange& range, double depth) {
    constexpr float nearest = 0.9f, farthest = 0.25f;
    const double share = (depth - range.near) / std::max(1e-9, range.far - range.near);
    return nearest + (farthest - nearest) * static_cast<float>(std::clamp(share, 0.0, 1.0));
}

void draw_boxes(const GuiFrame& frame, const Rect& area) {
    const ViewState& view = frame.view;
    if (!view.selected_box && !view.all_boxes) return;
    const Scene now = scene_at(frame.document.scene(), view.frame);
    for (std::size_t i = 0; i < std::min(now.layers.size(), frame.status.layers.size()); ++i) {
        const bool selected = i == view.layer;
        if (!(selected ? view.selected_box || view.all_boxes : view.all_boxes && now.layers[i].visible))
            continue;
        for (const MarkLine& edge : box_edges(frame.status.layers[i].box, now.layers[i].transform))
            draw_deep_line(frame, area, edge.from, edge.to, selected ? color::accent : color::dim, box_width);
    }
}

void draw_grid(const GuiFrame& frame, const Rect& area) {
    for (const MarkLine& line : grid_around(frame.status.box, frame.view.view).lines)
        draw_deep_line(frame, area, line.from, line.to, color::with_opacity(color::dim, 0.45f), grid_width);
}

void draw_axes(const GuiFrame& frame, const Rect& area) {
    constexpr std::array<const char*, 3> names{"x", "y", "z"};
    const auto axes = axis_lines(frame.status.box);
    for (std::size_t i = 0; i < 3; ++i) {
        draw_deep_line(frame, area, axes[i].from, axes[i].to, color::axes[i], axis_width);
        if (const auto end = project_point(*frame.status.viewport_camera, axes[i].to))
            ImGui::GetWindowDrawList()->AddText({area.x + end->x + px(4), area.y + end->y - px(8)},
                                                color::axes[i], names[i]);
    }
}

}  // namespace

void draw_deep_line(const GuiFrame& frame, const Rect& area, const glm::dvec3& from, const glm::dvec3& to,
                    ImU32 ink, float width) {
    constexpr int pieces = 12;
    const Camera& camera = *frame.status.viewport_camera;
    const DepthRange range = depth_range(camera, frame.status.box);
    const float own = static_cast<float>(ink >> IM_COL32_A_SHIFT & 255) / 255.0f;
    for (int i = 0; i < pieces; ++i) {
        const auto at = [&](int n) { return from + (to - from) * (double(n) / pieces); };
        const ImU32 faded =
            color::with_opacity(ink, own * opacity_at(range, view_depth(camera, (at(i) + at(i + 1)) * 0.5)));
        for (const auto& part : project_line(camera, {at(i), at(i + 1)}))
            ImGui::GetWindowDrawList()->AddLine({area.x + part[0].x, area.y + part[0].y},
                                                {area.x + part[1].x, area.y + part[1].y}, faded, px(width));
    }
}

void draw_view_marks(const GuiFrame& frame, const Rect& area) {
    if (!frame.status.viewport_camera || frame.view.compare == CompareMode::front) return;
    if (frame.view.grid) draw_grid(frame, area);
    if (frame.view.axes) draw_axes(frame, area);
    draw_boxes(frame, area);
}

}  // namespace astrosplat
