#include "gui/handles.h"

#include <imgui.h>

#include <utility>

#include "edit/placement.h"
#include "gui/key_codes.h"
#include "gui/theme.h"
#include "gui/viewport_overlay.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

constexpr ImU32 shade = color::with_opacity(IM_COL32_BLACK, 0.55f);  // so that they are seen over white, too

HandleSizes sizes() {
    const HandleSizes standard;
    return {standard.length * double(px(1)), standard.reach * double(px(1))};
}

bool can_be_handled(const GuiFrame& frame) {
    return frame.view.tool != HandleTool::none && frame.status.viewport_camera &&
           frame.view.compare != CompareMode::front;
}

Scene scene_now(const GuiFrame& frame) { return scene_at(frame.document.scene(), frame.view.frame); }

/// The parts of a line that are seen, with a small square at the far end where that is grabbed.
void draw_handle(const Camera& camera, const Rect& area, const std::vector<glm::dvec3>& line, ImU32 ink,
                 bool square) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImVec2 end{};
    for (const auto& part : project_line(camera, line))
        for (const auto& [own, width] : {std::pair{shade, px(4)}, {ink, px(2)}}) {
            for (const glm::vec2& p : part) list->PathLineTo(end = {area.x + p.x, area.y + p.y});
            list->PathStroke(own, ImDrawFlags_None, width);
        }
    const float half = px(4);
    if (square) list->AddRectFilled({end.x - half, end.y - half}, {end.x + half, end.y + half}, ink);
}

void draw_crop(const GuiFrame& frame, const Rect& area, const Scene& now) {
    const ViewState& view = frame.view;
    if (view.handle_target != HandleTarget::crop || view.layer >= now.layers.size()) return;
    const LayerParams& layer = now.layers[view.layer];
    if (view.handle_crop >= layer.look.crop.size()) return;
    for (const auto& line : crop_outline(layer, view.handle_crop))
        for (std::size_t i = 1; i < line.size(); ++i)
            draw_deep_line(frame, area, line[i - 1], line[i], color::attention, 1.4f);
}

}  // namespace

bool Handles::press(const GuiFrame& frame, const glm::dvec2& mouse_px) {
    drag_ = {};
    if (!can_be_handled(frame)) return false;
    pressed_at_frame_ = scene_now(frame);
    const std::optional<Handled> handled = handled_in(pressed_at_frame_, frame.view);
    if (!handled) return false;
    camera_ = *frame.status.viewport_camera;
    drag_ = {grip_at(camera_, *handled, frame.view.tool, mouse_px, sizes()), mouse_px, mouse_px};
    if (drag_.grip == Grip::none) return false;
    pressed_ = frame.document.scene();
    gesture_ = new_gesture();
    return true;
}

void Handles::read(GuiFrame& frame, const glm::dvec2& mouse_px, bool dragged) {
    if (!dragged || drag_.grip == Grip::none) {
        drag_.grip = Grip::none;
        return;
    }
    if (key_pressed(key_code::escape)) {
        try_edit([&] {
            frame.document.edit(
                "Drag taken back", [&](Scene& scene) { scene = pressed_; }, gesture_);
        });
        drag_.grip = Grip::none;
        return;
    }
    if (mouse_px == drag_.to_px) return;
    drag_.to_px = mouse_px;
    try_edit([&] {
        const NewValue value = dragged_value(pressed_at_frame_, frame.view, camera_, drag_);
        frame.document.set(value.key, value.value, frame.view.frame, gesture_);
    });
}

void Handles::draw(const GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px) const {
    if (!can_be_handled(frame)) return;
    const Scene now = scene_now(frame);
    draw_crop(frame, area, now);
    const std::optional<Handled> handled = handled_in(now, frame.view);
    if (!handled) return;
    const Camera& camera = *frame.status.viewport_camera;
    const auto middle = project_point(camera, handled->origin);
    if (!middle) return;
    const bool drags = drag_.grip != Grip::none;
    const Grip lit = drags ? drag_.grip : grip_at(camera, *handled, frame.view.tool, mouse_px, sizes());
    const auto ink = [&](Grip grip, ImU32 own) { return grip == lit ? color::attention : own; };
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 at{area.x + middle->x, area.y + middle->y};
    const bool as_whole = frame.view.tool == HandleTool::scale && handled->uniform;
    if (as_whole) list->AddCircle(at, float(sizes().length), shade, 64, px(4));
    if (as_whole) list->AddCircle(at, float(sizes().length), ink(Grip::middle, color::text), 64, px(2));
    for (int axis = 0; axis < 3 && !as_whole; ++axis)
        draw_handle(camera, area, handle_line(camera, *handled, frame.view.tool, axis, sizes()),
                    ink(static_cast<Grip>(axis), color::axes[axis]), frame.view.tool != HandleTool::rotate);
    list->AddCircleFilled(at, px(7), shade);
    list->AddCircleFilled(at, px(5), ink(Grip::middle, color::text));
}

}  // namespace astrosplat
