// Drag: Shift coarse, Alt fine. Typing: Enter, Tab or leaving takes the text, Escape drops it. Heads, notes
// and buttons are drawn to the grid of the rows.
#include "gui/panel/controls.h"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "edit/edit_rules.h"
#include "gui/icons.h"
#include "gui/key_codes.h"
#include "gui/widgets.h"

namespace astrosplat::panel {
namespace {

void begin_entry(Touch& touch, ImGuiID id, const std::string& text) {
    touch.entry = id;
    touch.entry_frames = 0;
    touch.text = text;
}

BoxEvent type_value(Context& context, const char* id, const Rect& area) {
    Touch& touch = context.memory.touch;
    touch.seen = true;
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::SetNextItemWidth(area.width);
    const float padding = (area.height - ImGui::GetFontSize()) * 0.5f;
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

float padding_of(const Rect& area) { return area.width < px(80) ? px(5) : px(8); }

/// In the small font at the right edge; returns the room it took, 0 where there was not enough.
float unit_text(const Rect& area, const std::string& unit, float needed) {
    if (unit.empty()) return 0.0f;
    ImGui::PushFont(small_font());
    const float width = ImGui::CalcTextSize(unit.c_str()).x + px(8);
    const bool fits = needed + width <= area.width;
    if (fits)
        draw_text({area.end().x - width, area.y + (area.height - ImGui::GetFontSize()) * 0.5f}, color::dim,
                  unit);
    ImGui::PopFont();
    return fits ? width : 0.0f;
}

void draw_box(const Rect& area, const BoxContent& content, bool hovered, bool active) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float radius = px(3);
    fill_rect(area, hovered || active ? color::hover : color::field, radius);
    if (content.fill > 0.0f) {
        const float width = std::max(area.width * std::min(content.fill, 1.0f), radius);
        list->AddRectFilled(
            area.corner(), {area.x + width, area.end().y}, color::fill, radius,
            content.fill < 0.99f ? ImDrawFlags_RoundCornersLeft : ImDrawFlags_RoundCornersAll);
    }
    if (active) list->AddRect(area.corner(), area.end(), color::accent, radius);
    const float padding = padding_of(area);
    const float needed = ImGui::CalcTextSize(content.shown.c_str()).x + 2.0f * padding;
    const float unit = unit_text(area, content.unit, needed);
    const Rect rest{area.corner(), {area.width - unit, area.height}};
    clipped_text(rest, padding, content.dimmed ? color::dim : color::text, content.shown);
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

constexpr float head_height = 28.0f;

void head_text(const Rect& area, float left, const char* title, const std::string& state) {
    ImGui::PushFont(medium_font());
    const float used = clipped_text(area, left, color::text, title) + left + px(8);
    ImGui::PopFont();
    if (state.empty()) return;
    ImGui::PushFont(small_font());
    const float width = std::min(ImGui::CalcTextSize(state.c_str()).x + px(8), area.width - used);
    const Rect rest{{area.end().x - width, area.y}, {width, area.height}};
    clipped_text(rest, px(4), color::dim, state);
    ImGui::PopFont();
}

// From edge to edge of the window, beyond the padding its contents are clipped to.
void edge_line(float y) {
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    ImGui::PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, false);
    draw_line({corner.x, y}, {corner.x + size.x, y}, color::line);
    ImGui::PopClipRect();
}

}  // namespace

BoxEvent value_box(Context& context, const char* id, const Rect& area, const BoxContent& content) {
    Touch& touch = context.memory.touch;
    const ImGuiID own = ImGui::GetID(id);
    if (touch.to_next) {
        touch.to_next = false;
        begin_entry(touch, own, content.typed);
    }
    if (touch.entry == own) return type_value(context, id, area);
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton(id, area.size());
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

bool fits_box(const Rect& area, const std::string& text) {
    const float padding = padding_of(area);
    return ImGui::CalcTextSize(text.c_str()).x <= area.width - padding - std::min(padding, px(4));
}

float share_at_mouse(const Rect& area) {
    return std::clamp((ImGui::GetIO().MousePos.x - area.x) / area.width, 0.0f, 1.0f);
}

float clipped_text(const Rect& area, float padding, ImU32 color, const std::string& text) {
    const float y = area.y + (area.height - ImGui::GetFontSize()) * 0.5f;
    const ImVec2 from{area.x + padding, y};
    const float right = area.end().x - std::min(padding, px(4));
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::RenderTextEllipsis(ImGui::GetWindowDrawList(), from, {right, area.end().y}, right, right,
                              text.c_str(), text.c_str() + text.size(), &size);
    ImGui::PopStyleColor();
    return std::min(size.x, right - from.x);
}

bool section(Context& context, const char* title, const std::string& state, bool open_at_first) {
    Memory& memory = context.memory;
    bool& open = memory.open.emplace(std::pair(context.view.tab, title), open_at_first).first->second;
    open = open || memory.all_open;
    if (memory.after_open) ImGui::Dummy({0.0f, px(6)});
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Rect area{corner, {ImGui::GetContentRegionAvail().x, px(head_height)}};
    if (ImGui::InvisibleButton(title, area.size())) open = !open;
    edge_line(corner.y);
    const ImU32 sign = ImGui::IsItemHovered() ? color::text : color::dim;
    draw_icon(ImGui::GetWindowDrawList(), open ? Icon::chevron_down : Icon::chevron_right,
              {corner.x + px(4), area.middle().y}, px(8), sign);
    head_text(area, px(16), title, open ? "" : state);
    memory.after_open = open;
    return open;
}

bool element_head(const char* title) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Rect area{corner, {ImGui::GetContentRegionAvail().x, px(row_height)}};
    clipped_text(area, 0.0f, color::dim, title);
    ImGui::SetCursorScreenPos({area.end().x - px(20), corner.y});
    const bool removed =
        icon_button("remove", Icon::cross, {px(22), px(row_height)}, px(9), color::dim, "Remove");
    ImGui::SetCursorScreenPos(corner);
    ImGui::Dummy(area.size());
    return removed;
}

bool begin_popup(const char* id) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(7)));
    const bool open = ImGui::BeginPopup(id);
    if (!open) ImGui::PopStyleVar();
    return open;
}

void note(const std::string& text, ImU32 ink) {
    ImGui::PushFont(small_font());
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

bool text_button(const char* label, float width) {
    push_field_height(px(row_height));
    const bool clicked = ImGui::Button(label, {width, px(row_height)});
    ImGui::PopStyleVar();
    return clicked;
}

int button_line(Context& context, std::initializer_list<const char*> labels) {
    const float gap = px(4), count = static_cast<float>(labels.size());
    const float width = std::floor((ImGui::GetContentRegionAvail().x - gap * (count - 1.0f)) / count);
    int clicked = -1, index = 0;
    for (const char* label : labels) {
        if (index > 0) ImGui::SameLine(0.0f, gap);
        if (text_button(label, width)) clicked = index;
        note_item(context, std::string("panel/") + label);
        ++index;
    }
    return clicked;
}

bool add_line(const char* label) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Rect area{corner, {px(28) + ImGui::CalcTextSize(label).x, px(row_height)}};
    const bool clicked = ImGui::InvisibleButton(label, area.size());
    const ImU32 ink = ImGui::IsItemHovered() ? color::text : color::dim;
    draw_icon(ImGui::GetWindowDrawList(), Icon::plus, {corner.x + px(5), area.middle().y}, px(9), ink);
    clipped_text(area, px(16), ink, label);
    return clicked;
}

bool progress_line(float width, float share, const std::string& text, const char* button) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float button_width = ImGui::CalcTextSize(button).x + px(16);
    const Rect bar{corner, {width - button_width - px(4), px(row_height)}};
    fill_rect(bar, color::window, px(3));
    if (share > 0.0f)
        fill_rect(bar.corner(), {corner.x + bar.width * std::min(share, 1.0f), bar.end().y}, color::fill,
                  px(3));
    clipped_text(bar, px(8), share > 0.0f ? color::text : color::attention, text);
    ImGui::SetCursorScreenPos({bar.end().x + px(4), corner.y});
    return text_button(button, button_width);
}

}  // namespace astrosplat::panel
