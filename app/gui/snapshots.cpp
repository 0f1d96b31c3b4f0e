// A row of cards that scrolls sideways, and the button that takes another.
#include "gui/parts.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "gui/icons.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float thumbnail_width = 128, thumbnail_height = 72, card_height = 108, margin = 8;

std::string snapshot_line(const Snapshot& snapshot) {
    const std::string splats = short_count(snapshot.splats);
    return snapshot.seconds > 0 ? fmt::format("{}, {:.1f} s", splats, snapshot.seconds)
                                : splats + ", preview";
}

// In place of the name: Enter takes what was typed, Escape or a click elsewhere drops it.
void name_entry(GuiFrame& frame, std::size_t index, ImVec2 corner) {
    ViewState& view = frame.view;
    ImGui::SetCursorScreenPos(corner);
    ImGui::SetNextItemWidth(px(thumbnail_width));
    if (!any_popup() && !ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText(
        "##name", &view.typed_name, ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_EnterReturnsTrue);
    note_item(frame, "snapshot name");
    if (entered && !view.typed_name.empty())
        request_text(frame, Command::Kind::rename_snapshot, view.typed_name, index);
    if (ImGui::IsItemDeactivated()) view.renamed_snapshot = -1;
}

void card_menu(GuiFrame& frame, std::size_t index) {
    ImGui::OpenPopupOnItemClick("card menu");
    if (!begin_menu_popup("card menu")) return;
    const auto entry = [&](const char* label) { return noted_menu_item(frame, "snapshot", label); };
    if (entry("Show")) request(frame, Command::Kind::show_snapshot, index);
    if (entry("Compare as B")) request(frame, Command::Kind::compare_snapshot, index);
    if (entry("Restore")) request(frame, Command::Kind::restore_snapshot, index);
    ImGui::Separator();
    if (entry("Rename")) {
        frame.view.renamed_snapshot = static_cast<int>(index);
        frame.view.typed_name = frame.status.snapshots[index].name;
    }
    if (entry("Delete")) request(frame, Command::Kind::delete_snapshot, index);
    end_menu_popup();
}

void draw_card(GuiFrame& frame, std::size_t index) {
    const Snapshot& snapshot = frame.status.snapshots[index];
    ImGui::PushID(static_cast<int>(index));
    ImGui::BeginGroup();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("card", {px(thumbnail_width), px(card_height)}))
        request(frame, Command::Kind::compare_snapshot, index);
    note_item(frame, fmt::format("snapshot {}", index));
    const bool hovered = ImGui::IsItemHovered(), is_b = frame.status.b_snapshot == static_cast<int>(index);
    tooltip("Click: compare as B. Right click: show, restore, rename, delete");
    ImGui::SetItemAllowOverlap();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Rect area(corner, {px(thumbnail_width), px(thumbnail_height)});
    picture_box(area, snapshot.thumbnail, snapshot.aspect, 3);
    const ImVec2 end = area.end();
    if (is_b || hovered) list->AddRect(corner, end, is_b ? color::accent : color::dim, px(3), 0, px(1.5f));
    ImGui::PushFont(small_font());
    const bool is_renamed = frame.view.renamed_snapshot == static_cast<int>(index);
    const std::string name = (is_b ? "B  " : "") + snapshot.name;
    if (!is_renamed)
        draw_text({corner.x, end.y + px(3)}, is_b ? color::accent : color::text,
                  fitting(name, px(thumbnail_width)));
    draw_text({corner.x, end.y + px(18)}, color::dim, snapshot_line(snapshot));
    ImGui::PopFont();
    card_menu(frame, index);
    if (is_renamed) name_entry(frame, index, {corner.x, end.y + px(2)});
    ImGui::EndGroup();
    ImGui::PopID();
}

void draw_take_button(GuiFrame& frame) {
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size{px(72), px(thumbnail_height)};
    if (icon_button("take snapshot", Icon::plus, size, px(14), color::dim,
                    "Keep the look and the view as they are now"))
        request(frame, Command::Kind::take_snapshot);
    note_item(frame, "take snapshot");
    ImGui::GetWindowDrawList()->AddRect(corner, {corner.x + size.x, corner.y + size.y}, color::hover, px(3));
}

}  // namespace

void draw_snapshots(GuiFrame& frame, const Rect& area) {
    if (!begin_part("snapshots", area, ImGuiWindowFlags_HorizontalScrollbar)) return;
    ImGui::SetCursorPos({px(margin), px(margin)});
    draw_take_button(frame);
    for (std::size_t i = 0; i < frame.status.snapshots.size(); ++i) {
        ImGui::SameLine(0, px(margin));
        draw_card(frame, i);
    }
    if (frame.status.snapshots.empty()) {
        ImGui::SameLine(0, px(12));
        row_text("Snapshots keep a look with its thumbnail, to compare with and to come back to.",
                 px(thumbnail_height), color::dim);
    }
    ImGui::EndChild();
}

}  // namespace astrosplat
