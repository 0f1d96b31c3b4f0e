// Shared controls.
#include "gui/widgets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gui/key_codes.h"

namespace astrosplat {
namespace {

constexpr float segment_padding = 10.0f;
constexpr float wait_s = 0.5f;  // before a tooltip

// Length of the UTF-8 character that begins at `at`; bytes that begin none count as one.
std::size_t character_length(const std::string& text, std::size_t at) {
    std::size_t end = at + 1;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
    return end - at;
}

}  // namespace

bool begin_part(const char* name, const Rect& area, ImGuiWindowFlags flags) {
    if (area.width <= 0 || area.height <= 0) return false;
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::BeginChild(name, area.size(), false, flags);
    ImGui::PopStyleVar();
    return true;
}

void tooltip(const char* text) {
    if (!text || !ImGui::IsItemHovered()) return;
    static ImVec2 resting;  // where the mouse came to rest, and when: one mouse, one tooltip
    static double since = 0.0;
    const ImVec2 mouse = ImGui::GetMousePos();
    if (mouse.x != resting.x || mouse.y != resting.y) {
        resting = mouse;
        since = ImGui::GetTime();
    }
    if (ImGui::GetTime() - since >= wait_s) ImGui::SetTooltip("%s", text);
}

float segmented_width(std::initializer_list<Segment> segments) {
    float width = 0.0f;
    for (const Segment& segment : segments)
        width += std::round(ImGui::CalcTextSize(segment.label).x + 2 * px(segment_padding));
    return width;
}

void push_field_height(float height) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), (height - ImGui::GetFontSize()) * 0.5f));
}

bool any_popup() {
    return ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

void close_on_escape() {
    if (key_pressed(key_code::escape)) ImGui::CloseCurrentPopup();
}

void fill_rect(ImVec2 low, ImVec2 high, ImU32 ink, float radius) {
    ImGui::GetWindowDrawList()->AddRectFilled(low, high, ink, radius);
}
void fill_rect(const Rect& area, ImU32 ink, float radius) {
    fill_rect(area.corner(), area.end(), ink, radius);
}
void draw_line(ImVec2 from, ImVec2 to, ImU32 ink, float width) {
    ImGui::GetWindowDrawList()->AddLine(from, to, ink, width);
}
void draw_text(ImVec2 at, ImU32 ink, const std::string& text) {
    ImGui::GetWindowDrawList()->AddText(at, ink, text.c_str());
}

void row_text(const std::string& text, float row_height, ImU32 text_color) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    ImGui::GetWindowDrawList()->AddText({at.x, at.y + std::floor((row_height - size.y) * 0.5f)}, text_color,
                                        text.c_str());
    ImGui::Dummy({size.x, row_height});
}

void progress_bar(ImVec2 corner, float width, float share) {
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const float done = corner.x + width * std::clamp(share, 0.0f, 1.0f), bottom = corner.y + px(4);
    list->AddRectFilled(corner, {corner.x + width, bottom}, color::field, px(2));
    list->AddRectFilled(corner, {done, bottom}, color::accent, px(2));
}

void picture_box(const Rect& area, ImTextureID texture, float aspect, float radius) {
    ImDrawList* const list = ImGui::GetWindowDrawList();
    list->AddRectFilled(area.corner(), area.end(), IM_COL32_BLACK, px(radius));
    if (!texture || aspect <= 0) return;
    const float w = std::max(px(1), std::min(area.width, area.height * aspect));
    const float h = std::max(px(1), std::min(area.height, area.width / aspect));
    const float x = area.x + (area.width - w) * 0.5f, y = area.y + (area.height - h) * 0.5f;
    list->AddImage(texture, {x, y}, {x + w, y + h});
}

bool begin_menu_popup(const char* id) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
    const bool open = ImGui::BeginPopup(id);
    ImGui::PopStyleVar();
    if (open) ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(12), px(8)));
    return open;
}

void end_menu_popup() {
    close_on_escape();
    ImGui::PopStyleVar();
    ImGui::EndPopup();
}

std::string fitting(const std::string& text, float width) {
    if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
    std::vector<std::string> characters;
    for (std::size_t i = 0; i < text.size(); i += characters.back().size())
        characters.push_back(text.substr(i, character_length(text, i)));
    // Takes characters out of the middle, one after the other.
    std::size_t head = characters.size() / 2, tail = characters.size() - head;
    while (head + tail > 2) {
        (head > tail ? head : tail)--;
        std::string shorter;
        for (std::size_t i = 0; i < head; ++i) shorter += characters[i];
        shorter += "\xE2\x80\xA6";
        for (std::size_t i = characters.size() - tail; i < characters.size(); ++i) shorter += characters[i];
        if (ImGui::CalcTextSize(shorter.c_str()).x <= width) return shorter;
    }
    return "\xE2\x80\xA6";
}

}  // namespace astrosplat
