// Drag: Shift coarse, Alt fine. Typing: Enter, Tab or leaving takes the text, Escape drops it.
#include "gui/panel/box.h"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "gui/key_codes.h"
#include "gui/panel/words.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

void begin_entry(Touch& touch, ImGuiID id, const std::string& text) {
    touch.entry = id;
    touch.entry_frames = 0;
    touch.text = text;
}

BoxEvent type_value(Context& context, const char* id, const Area& area) {
    Touch& touch = context.memory.touch;
    touch.seen = true;
    ImGui::SetCursorScreenPos(area.corner);
    ImGui::SetNextItemWidth(area.size.x);
    const float padding = (area.size.y - ImGui::GetFontSize()) * 0.5f;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(7), padding));
    ImGui::PushID(id);
    if (touch.entry_frames == 0) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("##entry", &touch.text, ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopID();
    ImGui::PopStyleVar();
    const bool tab = ImGui::IsItemActive() && key_pressed(key_code::tab, true);
    if (tab) ImGui::ClearActiveID();
    const bool left = tab || ImGui::IsItemDeactivated();
    const bool dropped = key_pressed(key_code::escape, true);
    const bool never_active = !ImGui::IsItemActive() && ++touch.entry_frames > 4;
    if (ImGui::IsItemActive()) touch.entry_frames = 1;
    if (!left && !never_active) {
        touch.entry_frames = std::max(touch.entry_frames, 1);
        return {};
    }
    touch.entry = 0;
    touch.to_next = tab;
    if (dropped || never_active) return {};
    return {BoxEvent::Kind::typed, 0.0, touch.text};
}

float padding_of(const Area& area) { return area.size.x < px(80) ? px(5) : px(8); }

void draw_box(const Area& area, const BoxContent& content, bool hovered, bool active) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float radius = px(3);
    list->AddRectFilled(area.corner, area.end(), hovered || active ? color::hover : color::field, radius);
    if (content.fill > 0.0f) {
        const float width = std::max(area.size.x * std::min(content.fill, 1.0f), radius);
        list->AddRectFilled(
            area.corner, {area.corner.x + width, area.end().y}, color::fill, radius,
            content.fill < 0.99f ? ImDrawFlags_RoundCornersLeft : ImDrawFlags_RoundCornersAll);
    }
    if (active) list->AddRect(area.corner, area.end(), color::accent, radius);
    const float padding = padding_of(area);
    const float needed = ImGui::CalcTextSize(content.shown.c_str()).x + 2.0f * padding;
    const float unit = unit_text(list, area, content.unit, needed);
    const Area rest{area.corner, {area.size.x - unit, area.size.y}};
    clipped_text(list, rest, padding, content.dimmed ? color::dim : color::text, content.shown);
}

BoxEvent drag_value(Context& context, const BoxContent& content) {
    Touch& touch = context.memory.touch;
    if (ImGui::IsItemActivated()) {
        begin_gesture(context);
        touch.drag = ImGui::GetItemID();
        touch.value = content.value;
        touch.mouse_x = ImGui::GetIO().MousePos.x;
    }
    if (!ImGui::IsItemActive() || touch.drag != ImGui::GetItemID()) return {};
    touch.seen = true;
    const ImGuiIO& io = ImGui::GetIO();
    const float moved = io.MousePos.x - touch.mouse_x;
    if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left, px(3)) || moved == 0.0f) return {};
    touch.mouse_x = io.MousePos.x;
    const double factor = io.KeyAlt ? 0.1 : io.KeyShift ? 10.0 : 1.0;
    const double step = content.step * factor;
    touch.value = std::clamp(touch.value + step * double(moved), content.min, content.max);
    const double fine = content.whole ? 1.0 : step;
    const double value = std::clamp(rounded_to_step(touch.value, fine), content.min, content.max);
    return {BoxEvent::Kind::dragged, value, ""};
}

}  // namespace

BoxEvent value_box(Context& context, const char* id, const Area& area, const BoxContent& content) {
    Touch& touch = context.memory.touch;
    const ImGuiID own = ImGui::GetID(id);
    if (touch.to_next) {
        touch.to_next = false;
        begin_entry(touch, own, content.typed);
    }
    if (touch.entry == own) return type_value(context, id, area);
    ImGui::SetCursorScreenPos(area.corner);
    ImGui::InvisibleButton(id, area.size);
    const bool hovered = ImGui::IsItemHovered();
    const bool wants_text =
        hovered && (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) ||
                    (ImGui::IsItemActivated() && (ImGui::GetIO().KeyCtrl || content.step == 0.0)));
    draw_box(area, content, hovered, ImGui::IsItemActive());
    if (wants_text) {
        ImGui::ClearActiveID();
        touch.drag = 0;
        begin_entry(touch, own, content.typed);
        touch.seen = true;
        return {};
    }
    if (content.step == 0.0) return {};
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    return drag_value(context, content);
}

bool fits_box(const Area& area, const std::string& text) {
    const float padding = padding_of(area);
    return ImGui::CalcTextSize(text.c_str()).x <= area.size.x - padding - std::min(padding, px(4));
}

float clipped_text(ImDrawList* list, const Area& area, float padding, ImU32 color, const std::string& text) {
    const float y = area.corner.y + (area.size.y - ImGui::GetFontSize()) * 0.5f;
    const ImVec2 from{area.corner.x + padding, y};
    const float right = area.end().x - std::min(padding, px(4));
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::RenderTextEllipsis(list, from, {right, area.end().y}, right, right, text.c_str(),
                              text.c_str() + text.size(), &size);
    ImGui::PopStyleColor();
    return std::min(size.x, right - from.x);
}

float unit_text(ImDrawList* list, const Area& area, const std::string& unit, float needed) {
    if (unit.empty()) return 0.0f;
    ImGui::PushFont(small_font());
    const float width = ImGui::CalcTextSize(unit.c_str()).x + px(8);
    const bool fits = needed + width <= area.size.x;
    if (fits)
        list->AddText({area.end().x - width, area.corner.y + (area.size.y - ImGui::GetFontSize()) * 0.5f},
                      color::dim, unit.c_str());
    ImGui::PopFont();
    return fits ? width : 0.0f;
}

}  // namespace astrosplat::panel
