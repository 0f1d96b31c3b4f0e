// The few things all parts of the window do.
#include "gui/gui_frame.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"

namespace astrosplat {

void request(GuiFrame& frame, Command::Kind kind, std::size_t index) {
    frame.requested.push_back({kind, {}, {}, index});
}
void request_path(GuiFrame& frame, Command::Kind kind, const fs::path& path) {
    frame.requested.push_back({kind, path, {}, 0});
}
void request_text(GuiFrame& frame, Command::Kind kind, const std::string& text, std::size_t index) {
    frame.requested.push_back({kind, {}, text, index});
}

void try_edit(const std::function<void()>& edit) {
    try {
        edit();
    } catch (const InputError& error) {
        log_error(error.what());
    } catch (const OutputError& error) {
        log_error(error.what());
    }
}

Gesture new_gesture() {
    static Gesture last = Gesture{1} << 63;  // the viewer counts drags in the view from 1
    return ++last;
}

void DragEdit::begin(const Document& document) {
    before_ = document.scene();
    gesture_ = new_gesture();
}

bool DragEdit::taken_back(GuiFrame& frame) const {
    if (!key_pressed(key_code::escape)) return false;
    try_edit([&] {
        frame.document.edit(
            "Drag taken back", [&](Scene& scene) { scene = before_; }, gesture_);
    });
    return true;
}

void note_item(GuiFrame& frame, const std::string& name) {
    const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
    note_item(frame, name, {(lo.x + hi.x) * 0.5f, (lo.y + hi.y) * 0.5f});
}
void note_item(GuiFrame& frame, const std::string& name, glm::vec2 middle_px) {
    frame.drawn.push_back({name, middle_px});
}

bool noted_menu_item(GuiFrame& frame, const std::string& prefix, const char* label, bool checked,
                     bool enabled) {
    const bool chosen = ImGui::MenuItem(label, nullptr, checked, enabled);
    note_item(frame, prefix + "/" + label);
    return chosen;
}

bool drag_field(GuiFrame& frame, float& value, const DragField& field) {
    ImGui::SetNextItemWidth(px(field.width));
    ImGui::PushStyleColor(ImGuiCol_Text, field.ink);
    const bool changed = ImGui::DragFloat((std::string("##") + field.name).c_str(), &value, field.speed,
                                          field.low, field.high, field.format, ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    note_item(frame, field.name);
    tooltip(field.says);
    return changed;
}

int segmented(GuiFrame& frame, const std::string& prefix, std::initializer_list<Segment> segments, int chosen,
              float height) {
    ImGui::PushID(prefix.c_str());
    Rect button(ImGui::GetCursorScreenPos(), {segmented_width(segments), px(height)});
    const float radius = px(3);
    fill_rect(button, color::field, radius);
    int clicked = -1, index = 0;
    for (const Segment& segment : segments) {
        button.width = segmented_width({segment});
        ImGui::SetCursorScreenPos(button.corner());
        if (ImGui::InvisibleButton(segment.label, button.size())) clicked = index;
        note_item(frame, prefix + "/" + segment.label);
        if (index == chosen)
            fill_rect(button, color::selection, radius);
        else if (ImGui::IsItemHovered())
            fill_rect(button, color::hover, radius);
        tooltip(segment.tooltip);
        const ImVec2 size = ImGui::CalcTextSize(segment.label);
        draw_text({std::floor(button.x + (button.width - size.x) * 0.5f),
                   std::floor(button.y + (button.height - size.y) * 0.5f)},
                  index == chosen ? color::text : color::dim, segment.label);
        button.x += button.width;
        ++index;
    }
    ImGui::PopID();
    return clicked;
}

std::string short_count(std::int64_t count) {
    const double n = static_cast<double>(count);
    if (count < 1000) return fmt::format("{}", count);
    if (n < 9.95e3) return fmt::format("{:.1f} k", n / 1e3);
    if (n < 999.5e3) return fmt::format("{:.0f} k", n / 1e3);
    if (n < 99.95e6) return fmt::format("{:.1f} M", n / 1e6);
    if (n < 999.5e6) return fmt::format("{:.0f} M", n / 1e6);
    return fmt::format("{:.1f} G", n / 1e9);
}

std::string splat_count(std::int64_t count) {
    return short_count(count) + (count == 1 ? " splat" : " splats");
}

}  // namespace astrosplat
