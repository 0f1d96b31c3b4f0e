// Shortcuts from the table of actions, the mouse from a table here; the log as it is.
#include "gui/parts.h"

#include <imgui.h>

#include <array>
#include <string_view>
#include <vector>

#include "gui/actions.h"
#include "gui/dialog.h"
#include "gui/key_codes.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float row_height = 20;

struct Row {
    std::string does, shortcut;
};
struct Group {
    std::string title;
    std::vector<Row> rows;
};

const Group& mouse_group() {
    static const Group group{"Mouse in the view",
                             {{"Select a layer, the next behind", "Click, Ctrl+click"},
                              {"Orbit about the pivot", "Left"},
                              {"Move", "Middle, Shift+Left"},
                              {"Nearer, to the cursor", "Wheel"},
                              {"Look around", "Right"},
                              {"Fly while looking", "W A S D Q E"},
                              {"Fly ten times faster", "Shift"},
                              {"Fly ten times slower", "Alt"},
                              {"Speed of flying", "Right + wheel"},
                              {"Set the pivot", "Double click"},
                              {"As in Maya and Houdini", "Alt+Left, Middle, Right"}}};
    return group;
}
const Group& value_group() {
    static const Group group{"Values",
                             {{"Change", "Drag"},
                              {"Coarse, fine", "Shift, Alt"},
                              {"Type", "Double click"},
                              {"Reset, keyframe, copy, paste", "Right click"}}};
    return group;
}
const Group& timeline_group() {
    static const Group group{"Timeline",
                             {{"Move keyframes", "Drag"},
                              {"Copy keyframes", "Ctrl+drag"},
                              {"Select more", "Shift+click, box"},
                              {"Remove keyframes", "Del"},
                              {"Zoom", "Wheel on the ruler"},
                              {"Zoom and move the graph", "Wheel, Middle"},
                              {"Break a handle", "Alt+drag"}}};
    return group;
}

Group group_of(const char* title, std::initializer_list<std::string_view> menus) {
    Group group{title, {}};
    for (const Action& action : actions())
        for (const std::string_view menu : menus)
            if (menu == action.menu && action.shortcut.code != 0)
                group.rows.push_back({action.label, shortcut_text(action.shortcut)});
    return group;
}

void draw_group(const Group& group) {
    ImGui::PushFont(medium_font());
    row_text(group.title, px(28), color::text);
    ImGui::PopFont();
    const float room = ImGui::GetContentRegionAvail().x;
    for (const Row& row : group.rows) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImDrawList* list = ImGui::GetWindowDrawList();
        const float shortcut_width = ImGui::CalcTextSize(row.shortcut.c_str()).x;
        list->AddText(at, color::dim, fitting(row.does, room - shortcut_width - px(12)).c_str());
        list->AddText({at.x + room - shortcut_width, at.y}, color::text, row.shortcut.c_str());
        ImGui::Dummy({room, px(row_height)});
    }
    ImGui::Dummy({0, px(8)});
}

}  // namespace

void draw_shortcut_sheet(GuiFrame& frame) {
    bool& open = frame.view.help_open;
    if (!begin_dialog("shortcuts", "Shortcuts and mouse", open, 1040, 656)) return;
    const float bottom = px(40);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(28), 0));
    ImGui::BeginChild("groups", {0, ImGui::GetContentRegionAvail().y - bottom}, false,
                      ImGuiWindowFlags_NoScrollbar);
    const float column = (ImGui::GetContentRegionAvail().x - 2 * px(28)) / 3;
    const std::array<std::vector<Group>, 3> columns{
        {{mouse_group(), value_group(), timeline_group()},
         {group_of("View", {"View"}), group_of("Layer", {"Layer"})},
         {group_of("Time", {""}), group_of("Scene", {"File", "Edit", "Render", "Help"})}}};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (i > 0) ImGui::SameLine();
        ImGui::BeginGroup();
        ImGui::BeginChild(static_cast<ImGuiID>(i + 1), {column, 0});
        for (const Group& group : columns[i]) draw_group(group);
        ImGui::EndChild();
        ImGui::EndGroup();
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::SetCursorPosY(ImGui::GetWindowHeight() - px(44));
    if (dialog_buttons(frame, "shortcuts", {"Close"}, true) == 0 || dialog_escape() ||
        (key_pressed(key_code::f1) && !ImGui::IsWindowAppearing())) {
        open = false;
        ImGui::CloseCurrentPopup();
    }
    end_dialog();
}

void draw_log(GuiFrame& frame) {
    bool& open = frame.view.log_open;
    if (!begin_dialog("log", "Log", open, 860, 480)) return;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, color4(color::window));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(12), px(8)));
    ImGui::BeginChild("lines", {0, ImGui::GetContentRegionAvail().y - px(40)}, false,
                      ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PopStyleVar();
    if (frame.status.log.empty()) ImGui::TextColored(color4(color::dim), "Nothing has been said yet.");
    ImGui::PushTextWrapPos(0.0f);
    for (const Message& message : frame.status.log)
        ImGui::TextColored(color4(message.error ? color::error : color::text), "%s", message.text.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::IsWindowAppearing()) ImGui::SetScrollHereY(1.0f);
    ImGui::EndChild();
    ImGui::PopStyleColor();
    ImGui::SetCursorPosY(ImGui::GetWindowHeight() - px(44));
    const int button = dialog_buttons(frame, "log", {"Copy all", "Close"}, true);
    if (button == 0) {
        std::string text;
        for (const Message& message : frame.status.log) text += message.text + "\n";
        frame.requested.push_back({Command::Kind::copy_text, {}, text, 0});
    }
    if (button == 1 || dialog_escape()) {
        open = false;
        ImGui::CloseCurrentPopup();
    }
    end_dialog();
}

}  // namespace astrosplat
