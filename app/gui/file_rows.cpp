#include "gui/file_rows.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float time_width = 128, size_width = 76;

struct FileColumn {
    const char* label;
    FileOrder order;
    float x, width;  // px
    bool at_right;
};

// Its name, and an arrow where the rows are in its order. True when clicked.
bool draw_column(GuiFrame& frame, const FileColumn& column, const ImVec2& corner, bool chosen,
                 bool backwards) {
    const float row = px(file_row_height), middle = corner.y + row * 0.5f;
    ImGui::SetCursorScreenPos({corner.x + column.x, corner.y});
    const bool clicked = ImGui::InvisibleButton(column.label, {column.width, row});
    note_item(frame, std::string("file/by ") + column.label);
    const ImU32 text_color = chosen || ImGui::IsItemHovered() ? color::text : color::dim;
    const float text_width = ImGui::CalcTextSize(column.label).x;
    const float text_x = corner.x + column.x + (column.at_right ? column.width - px(8) - text_width : 0.0f);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText({text_x, middle - std::floor(ImGui::GetFontSize() * 0.5f)}, text_color, column.label);
    const float arrow_x = column.at_right ? text_x - px(12) : text_x + text_width + px(12);
    const Icon arrow = backwards ? Icon::chevron_up : Icon::chevron_down;
    if (chosen) draw_icon(list, arrow, {arrow_x, middle}, px(9), color::dim);
    return clicked;
}

}  // namespace

std::string size_text(std::uintmax_t bytes) {
    const double n = static_cast<double>(bytes);
    if (n < 1e3) return fmt::format("{} B", bytes);
    if (n < 1e6) return fmt::format("{:.0f} kB", n / 1e3);
    if (n < 1e9) return fmt::format("{:.1f} MB", n / 1e6);
    return fmt::format("{:.1f} GB", n / 1e9);
}

FileClick file_row(const char* id, Icon icon, const std::string& text, bool chosen, const std::string& time,
                   const std::string& size) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float row = px(file_row_height), room = ImGui::GetContentRegionAvail().x;
    FileClick click;
    click.once = ImGui::InvisibleButton(id, {room, row});
    click.twice = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 back = chosen ? color::selection : ImGui::IsItemHovered() ? color::hover : color::none;
    list->AddRectFilled(corner, {corner.x + room, corner.y + row}, back, px(3));
    draw_icon(list, icon, {corner.x + px(14), corner.y + row * 0.5f}, px(13), color::dim);
    const float y = corner.y + std::floor((row - ImGui::GetFontSize()) * 0.5f);
    const float beside = time.empty() ? 0.0f : px(time_width + size_width);
    list->AddText({corner.x + px(28), y}, color::text, fitting(text, room - px(36) - beside).c_str());
    list->AddText({corner.x + room - beside, y}, color::dim, time.c_str());
    const float size_x = corner.x + room - px(8) - ImGui::CalcTextSize(size.c_str()).x;
    list->AddText({size_x, y}, color::dim, size.c_str());
    return click;
}

bool draw_file_columns(GuiFrame& frame, FileOrder& order, bool& backwards) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float room = ImGui::GetContentRegionAvail().x, time_x = room - px(time_width + size_width);
    const FileColumn columns[] = {{"Name", FileOrder::name, px(28), time_x - px(28), false},
                                  {"Changed", FileOrder::changed, time_x, px(time_width), false},
                                  {"Size", FileOrder::size, room - px(size_width), px(size_width), true}};
    bool clicked = false;
    for (const FileColumn& column : columns) {
        if (!draw_column(frame, column, corner, order == column.order, backwards)) continue;
        backwards = order == column.order && !backwards;
        order = column.order;
        clicked = true;
    }
    ImGui::SetCursorScreenPos({corner.x, corner.y + px(file_row_height)});
    return clicked;
}

}  // namespace astrosplat
