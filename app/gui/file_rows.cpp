// The rows of the file dialog and the columns above them.
#include <fmt/format.h>

#include <cmath>

#include "gui/file_dialog.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float time_width = 128, size_width = 76;
constexpr float row_picture_width = 72, row_picture_height = 48;

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
    draw_text({text_x, middle - std::floor(ImGui::GetFontSize() * 0.5f)}, text_color, column.label);
    const float arrow_x = column.at_right ? text_x - px(12) : text_x + text_width + px(12);
    const Icon arrow = backwards ? Icon::chevron_up : Icon::chevron_down;
    if (chosen) draw_icon(list, arrow, {arrow_x, middle}, px(9), color::dim);
    return clicked;
}

// As large as its frame allows; the sign of a file where it cannot be read.
void draw_picture(ImVec2 corner, const ListedThumbnail* thumbnail) {
    const Rect area(corner, {px(row_picture_width), px(row_picture_height)});
    if (!thumbnail || !thumbnail->texture) {
        picture_box(area, {}, 0.0f, 2);
        if (thumbnail) draw_icon(ImGui::GetWindowDrawList(), Icon::file, area.middle(), px(13), color::dim);
        return;
    }
    const float aspect = static_cast<float>(thumbnail->width) / static_cast<float>(thumbnail->height);
    picture_box(area, thumbnail->texture, aspect, 2);
}

std::string note_of(const FileRow& row) {
    if (!row.thumbnail || !row.thumbnail->texture) return {};
    return fmt::format("{} x {} px", row.thumbnail->width, row.thumbnail->height);
}

}  // namespace

FileClick file_row(const char* id, const FileRow& row) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = px(row.high ? picture_row_height : file_row_height);
    const float room = ImGui::GetContentRegionAvail().x;
    FileClick click;
    click.once = ImGui::InvisibleButton(id, {room, height});
    click.twice = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 back = row.chosen ? color::selection : ImGui::IsItemHovered() ? color::hover : color::none;
    fill_rect(corner, {corner.x + room, corner.y + height}, back, px(3));
    const float middle = corner.y + height * 0.5f;
    if (row.picture)
        draw_picture({corner.x + px(6), middle - px(0.5f * row_picture_height)}, row.thumbnail);
    else
        draw_icon(list, row.icon, {corner.x + px(row.high ? 6 + 0.5f * row_picture_width : 14), middle},
                  px(13), color::dim);
    const float text_x = corner.x + px(row.high ? row_picture_width + 16 : 28);
    const float beside = row.time.empty() ? 0.0f : px(time_width + size_width);
    const float text_room = corner.x + room - px(8) - beside - text_x;
    const float line = std::floor(ImGui::GetFontSize()), y = std::floor(middle - line * 0.5f);
    const std::string note = note_of(row);
    const float name_y = note.empty() ? y : y - std::floor(line * 0.6f);
    draw_text({text_x, name_y}, color::text, fitting(row.text, text_room));
    draw_text({text_x, name_y + std::floor(line * 1.2f)}, color::dim, note);
    draw_text({corner.x + room - beside, y}, color::dim, row.time);
    const float size_x = corner.x + room - px(8) - ImGui::CalcTextSize(row.size.c_str()).x;
    draw_text({size_x, y}, color::dim, row.size);
    return click;
}

bool draw_file_columns(GuiFrame& frame, float room, FileOrder& order, bool& backwards) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float time_x = room - px(time_width + size_width);
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
