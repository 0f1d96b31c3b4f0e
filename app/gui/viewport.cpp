// Draws the frame into the viewport and turns the mouse over it into drags and clicks.
#include "gui/viewport.h"

#include <glm/geometric.hpp>

#include "gui/viewport_overlay.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float wipe_grip = 6;    // px at either side
constexpr float click_reach = 4;  // px that the mouse may move between pressing and letting go
constexpr double zoom_least = 1.0 / 16, zoom_most = 32;
constexpr double notch_zoom = 1.189207115002721;  // a quarter of doubling, for a notch of the wheel

bool near_wipe(const GuiFrame& frame, const Rect& frame_area) {
    if (frame.view.compare != CompareMode::wipe) return false;
    const float edge = frame_area.x + frame_area.width * frame.view.wipe;
    return std::fabs(ImGui::GetIO().MousePos.x - edge) <= px(wipe_grip);
}

void draw_frame_in_view(const GuiFrame& frame, const Rect& area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (!frame.status.viewport_texture) {
        fill_rect(area, IM_COL32_BLACK);
        return;
    }
    // The texture's first row is the lowest.
    list->AddImage(frame.status.viewport_texture, area.corner(), area.end(), {0, 1}, {1, 0});
}

glm::dvec3 fly_direction() {
    const auto axis = [](int plus, int minus) {
        return (key_down(plus) ? 1.0 : 0.0) - (key_down(minus) ? 1.0 : 0.0);
    };
    return {axis('D', 'A'), axis('E', 'Q'), axis('W', 'S')};
}

}  // namespace

ViewportInput::Drag drag_of(int button, bool shift, bool alt) {
    using Drag = ViewportInput::Drag;
    if (alt) return button == 0 ? Drag::orbit : button == 2 ? Drag::pan : Drag::dolly;
    if (button == 0) return shift ? Drag::pan : Drag::orbit;
    return button == 2 ? Drag::pan : Drag::look;
}

void Viewport::begin_drag(GuiFrame& frame, const Rect& area, const Rect& frame_area) {
    const ImGuiIO& io = ImGui::GetIO();
    for (int button = 0; button < 3; ++button)
        if (io.MouseClicked[button]) button_ = button;
    input_.drag = drag_of(button_, io.KeyShift, io.KeyAlt);
    if (button_ == 0 && near_wipe(frame, frame_area)) {
        input_.drag = ViewportInput::Drag::wipe;
    } else if (button_ == 0 && !io.KeyAlt && places_reference(frame)) {
        input_.drag = ViewportInput::Drag::place;
        placing_.press(frame, frame_on_screen(frame_area), io.KeyShift);
    } else if (button_ == 0 && frame.view.picking_focus) {
        // a click, whatever could be dragged there
    } else if (button_ == 0 && !io.KeyAlt && !io.KeyShift && selecting_.press(frame, input_.mouse_px)) {
        input_.drag = ViewportInput::Drag::select;
    } else if (button_ == 0 && !io.KeyAlt && !io.KeyShift && lying_.press(frame, input_.mouse_px)) {
        input_.drag = ViewportInput::Drag::lying;
    } else if (button_ == 0 && !io.KeyAlt && path_points_.press(frame, area)) {
        input_.drag = ViewportInput::Drag::path;
    } else if (button_ == 0 && !io.KeyAlt && !io.KeyShift && handles_.press(frame, input_.mouse_px)) {
        input_.drag = ViewportInput::Drag::handle;
    }
    input_.drag_begins = true;
    moves_frame_ = input_.drag == ViewportInput::Drag::pan && frame.view.size == SizeMode::one_to_one;
}

// 1:1: pan and wheel move the frame in the window; the camera stays.
void Viewport::move_frame(GuiFrame& frame, const Rect& area) {
    ViewState& view = frame.view;
    if (view.size != SizeMode::one_to_one) return;
    if (moves_frame_ && input_.drag == ViewportInput::Drag::pan) {
        view.pan_px += input_.delta_px;
        input_.drag = ViewportInput::Drag::none;
        input_.drag_begins = false;
    }
    if (input_.wheel == 0.0f || input_.drag == ViewportInput::Drag::look) return;
    double zoom = view.zoom;
    for (int i = 0; i < std::abs(static_cast<int>(std::round(input_.wheel))); ++i)
        zoom *= input_.wheel > 0 ? notch_zoom : 1.0 / notch_zoom;
    zoom = std::clamp(zoom, zoom_least, zoom_most);
    if (std::fabs(zoom - std::round(zoom)) < 0.01) zoom = std::round(zoom);
    // The point under the mouse stays there.
    const glm::dvec2 from_middle = input_.mouse_px - glm::dvec2(area.width, area.height) * 0.5;
    view.pan_px = from_middle - (from_middle - view.pan_px) * (zoom / view.zoom);
    view.zoom = zoom;
    input_.wheel = 0.0f;
}

/// A press that was no drag, let go again.
void Viewport::read_click() {
    const ImGuiIO& io = ImGui::GetIO();
    const auto moved_px = [](const glm::dvec2& by) {
        return glm::length(by) > static_cast<double>(px(click_reach));
    };
    if (input_.drag_begins)
        may_click_ = input_.drag == ViewportInput::Drag::orbit && !io.KeyAlt && !input_.double_click;
    may_click_ = may_click_ && std::sqrt(io.MouseDragMaxDistanceSqr[0]) <= px(click_reach);
    if (!may_click_ || !io.MouseReleased[0]) return;
    may_click_ = false;
    const bool again = !moved_px(input_.mouse_px - clicked_px_);
    input_.click = io.KeyCtrl || again ? ViewportInput::Click::behind : ViewportInput::Click::in_front;
    clicked_px_ = input_.mouse_px;
}

void Viewport::read_mouse(GuiFrame& frame, const Rect& area, const Rect& frame_area) {
    const ImGuiIO& io = ImGui::GetIO();
    const ViewportInput::Drag before = input_.drag;
    const bool moved_before = moves_frame_;
    input_ = {};
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton("frame in view", {std::max(area.width, 1.0f), std::max(area.height, 1.0f)},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                               ImGuiButtonFlags_MouseButtonRight);
    note_item(frame, "frame in view");
    ImGui::SetItemAllowOverlap();
    input_.hovered = ImGui::IsItemHovered();
    input_.mouse_px = {io.MousePos.x - area.x, io.MousePos.y - area.y};
    input_.double_click = input_.hovered && io.MouseDoubleClicked[0] && !io.KeyAlt && !io.KeyShift;
    if (input_.hovered || ImGui::IsItemActive()) input_.wheel = io.MouseWheel;
    if (ImGui::IsItemActivated()) {
        begin_drag(frame, area, frame_area);
    } else if (ImGui::IsItemActive()) {
        input_.drag = moved_before ? ViewportInput::Drag::pan : before;
        input_.delta_px = {io.MouseDelta.x, io.MouseDelta.y};
    } else {
        input_.drag_ends = before != ViewportInput::Drag::none;
        moves_frame_ = false;
    }
    read_click();
    if (input_.drag == ViewportInput::Drag::look) {
        input_.fly = fly_direction();
        input_.speed = io.KeyShift ? 10.0 : io.KeyAlt ? 0.1 : 1.0;
    }
    const bool wiping = input_.drag == ViewportInput::Drag::wipe;
    if (wiping)
        frame.view.wipe =
            std::clamp((io.MousePos.x - frame_area.x) / std::max(frame_area.width, 1.0f), 0.0f, 1.0f);
    if (wiping || (input_.hovered && near_wipe(frame, frame_area)))
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (input_.hovered && frame.view.picking_focus) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (places_reference(frame)) placing_.read(frame, frame_on_screen(frame_area), input_);
    handles_.read(frame, input_.mouse_px, input_.drag == ViewportInput::Drag::handle);
    lying_.read(frame, input_.mouse_px, input_.drag == ViewportInput::Drag::lying);
    selecting_.read(frame, input_.mouse_px, input_.drag == ViewportInput::Drag::select);
    if (frame.view.select != SelectTool::none || input_.drag == ViewportInput::Drag::lying)
        input_.double_click = false;
    if (input_.drag == ViewportInput::Drag::path) {
        input_.double_click = false;
        if (!input_.drag_begins) path_points_.drag(frame);
    }
    if (input_.drag_ends && before == ViewportInput::Drag::path) path_points_.release(frame);
    move_frame(frame, area);
}

/// In place of all that is drawn and done there: any press ends it.
void Viewport::draw_movie(GuiFrame& frame, const Rect& area) {
    input_ = {};
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton("frame in view", {std::max(area.width, 1.0f), std::max(area.height, 1.0f)});
    note_item(frame, "frame in view");
    if (ImGui::IsItemActivated()) frame.view.movie.clear();
    draw_frame_in_view(frame, area);
    draw_scopes(frame, area);
    draw_badge(frame, area);
}

void Viewport::draw(GuiFrame& frame, const Rect& area) {
    if (!frame.view.movie.empty()) return draw_movie(frame, area);
    const auto place = [&] {
        const ViewFrameStatus& shown = frame.status.view_frame;
        return shown.width > 0 ? place_frame(frame.view, area, shown.width, shown.height) : area;
    };
    read_mouse(frame, area, place());
    const Rect frame_area = place();
    ImGui::PushClipRect(area.corner(), area.end(), true);
    draw_frame_in_view(frame, area);
    draw_view_marks(frame, area);
    draw_overlay_lines(frame, area);
    lying_.draw(frame, area, input_.mouse_px);
    handles_.draw(frame, area, input_.mouse_px);
    path_points_.draw(frame, area);
    selecting_.draw(frame, area, input_.mouse_px, input_.hovered);
    draw_gate(frame, area, frame_area);
    draw_wipe(frame, area, frame_area);
    if (places_reference(frame)) draw_placing(frame, frame_on_screen(frame_area));
    draw_view_line(frame, area, frame_area);
    draw_scale_bar(frame, area, frame_area);
    draw_scopes(frame, area);
    draw_side_badge(frame, area, draw_badge(frame, area));
    ImGui::PopClipRect();
    draw_start_card(frame, area);
    draw_select_bar(frame, area);
}

}  // namespace astrosplat
