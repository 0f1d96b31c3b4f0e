// Heads, notes and buttons, drawn to the grid of the rows.
#include "gui/panel/section.h"

#include <cmath>

#include "gui/icons.h"
#include "gui/panel/parts.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

constexpr float head_height = 28.0f;

void head_text(const Area& area, float left, const char* title, const std::string& state) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImGui::PushFont(medium_font());
    const float used = clipped_text(list, area, left, color::text, title) + left + px(8);
    ImGui::PopFont();
    if (state.empty()) return;
    ImGui::PushFont(small_font());
    const float width = std::min(ImGui::CalcTextSize(state.c_str()).x + px(8), area.size.x - used);
    const Area rest{{area.end().x - width, area.corner.y}, {width, area.size.y}};
    clipped_text(list, rest, px(4), color::dim, state);
    ImGui::PopFont();
}

// From edge to edge of the window, beyond the padding its contents are clipped to.
void edge_line(float y) {
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    ImGui::PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, false);
    ImGui::GetWindowDrawList()->AddLine({corner.x, y}, {corner.x + size.x, y}, color::line);
    ImGui::PopClipRect();
}

}  // namespace

bool section(Context& context, const char* title, const std::string& state, bool open_at_first) {
    Memory& memory = context.memory;
    bool& open = memory.open.emplace(std::pair(context.view.tab, title), open_at_first).first->second;
    open = open || memory.all_open;
    if (memory.after_open) ImGui::Dummy({0.0f, px(6)});
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Area area{corner, {ImGui::GetContentRegionAvail().x, px(head_height)}};
    if (ImGui::InvisibleButton(title, area.size)) open = !open;
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
    const Area area{corner, {ImGui::GetContentRegionAvail().x, px(row_height)}};
    clipped_text(ImGui::GetWindowDrawList(), area, 0.0f, color::dim, title);
    ImGui::SetCursorScreenPos({area.end().x - px(20), corner.y});
    const bool removed =
        icon_button("remove", Icon::cross, {px(22), px(row_height)}, px(9), color::dim, "Remove");
    ImGui::SetCursorScreenPos(corner);
    ImGui::Dummy(area.size);
    return removed;
}

bool begin_popup(const char* id) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(7)));
    const bool open = ImGui::BeginPopup(id);
    if (!open) ImGui::PopStyleVar();
    return open;
}

void end_popup() {
    ImGui::EndPopup();
    ImGui::PopStyleVar();
}

void note(const std::string& text, ImU32 color) {
    ImGui::PushFont(small_font());
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

void note(const std::string& text) { note(text, color::dim); }

bool text_button(const char* label, float width) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(px(8), (px(row_height) - ImGui::GetFontSize()) * 0.5f));
    const bool clicked = ImGui::Button(label, {width, px(row_height)});
    ImGui::PopStyleVar();
    return clicked;
}

int button_line(std::initializer_list<const char*> labels) {
    const float gap = px(4), count = static_cast<float>(labels.size());
    const float width = std::floor((ImGui::GetContentRegionAvail().x - gap * (count - 1.0f)) / count);
    int clicked = -1, index = 0;
    for (const char* label : labels) {
        if (index > 0) ImGui::SameLine(0.0f, gap);
        if (text_button(label, width)) clicked = index;
        ++index;
    }
    return clicked;
}

bool add_line(const char* label) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Area area{corner, {px(28) + ImGui::CalcTextSize(label).x, px(row_height)}};
    const bool clicked = ImGui::InvisibleButton(label, area.size);
    const ImU32 ink = ImGui::IsItemHovered() ? color::text : color::dim;
    draw_icon(ImGui::GetWindowDrawList(), Icon::plus, {corner.x + px(5), area.middle().y}, px(9), ink);
    clipped_text(ImGui::GetWindowDrawList(), area, px(16), ink, label);
    return clicked;
}

bool progress_line(float width, float share, const std::string& text, const char* button) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float button_width = ImGui::CalcTextSize(button).x + px(16);
    const Area bar{corner, {width - button_width - px(4), px(row_height)}};
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(bar.corner, bar.end(), color::window, px(3));
    if (share > 0.0f)
        list->AddRectFilled(bar.corner, {corner.x + bar.size.x * std::min(share, 1.0f), bar.end().y},
                            color::fill, px(3));
    clipped_text(list, bar, px(8), share > 0.0f ? color::text : color::attention, text);
    ImGui::SetCursorScreenPos({bar.end().x + px(4), corner.y});
    return text_button(button, button_width);
}

}  // namespace astrosplat::panel
