// The frame of dialogs, and the small ones: the settings, a row each from setting_rows(); the sheet of
// shortcuts, from the table of actions and one of the mouse; the log as it is; what becomes of keyframes when
// a move is added.
#include "gui/parts.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "edit/view_camera.h"
#include "gui/parts.h"

namespace astrosplat {
namespace {

constexpr float least_button = 84;

float button_width(const char* label, float least) {
    return std::max(px(least), ImGui::CalcTextSize(label).x + px(24));
}

// The key press that opened a dialog does not answer it.
bool pressed(int code) { return !ImGui::IsWindowAppearing() && key_pressed(code); }

}  // namespace

void end_dialog(bool closes) {
    if (closes) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

bool begin_dialog(const char* id, const std::string& title, bool open, float width, float height) {
    if (open && !ImGui::IsPopupOpen(id)) ImGui::OpenPopup(id);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float w = std::min(px(width), screen.x - px(40));
    const float h = height > 0 ? std::min(px(height), screen.y - px(40)) : 0.0f;
    ImGui::SetNextWindowPos({screen.x * 0.5f, screen.y * 0.5f}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({w, h});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(20), px(16)));
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                   (height > 0 ? 0 : ImGuiWindowFlags_AlwaysAutoResize);
    const bool shown = ImGui::BeginPopupModal(id, nullptr, flags);
    ImGui::PopStyleVar();
    if (!shown) return false;
    if (!open) {
        end_dialog(true);
        return false;
    }
    ImGui::PushFont(medium_font());
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(title.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopFont();
    ImGui::Dummy({0, px(6)});
    return true;
}

void dialog_note(const char* text, float gap) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored(color4(color::dim), "%s", text);
    ImGui::PopTextWrapPos();
    ImGui::Dummy({0, px(gap)});
}

bool dialog_escape() {
    return pressed(key_code::escape) && ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows);
}

bool dialog_button(const char* label, bool is_default, float least) {
    if (is_default) {
        ImGui::PushStyleColor(ImGuiCol_Button, color4(color::with_opacity(color::accent, 0.55f)));
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, color4(color::with_opacity(color::accent, 0.75f)));
    }
    const bool clicked = ImGui::Button(label, {button_width(label, least), px(28)});
    if (is_default) ImGui::PopStyleColor(2);
    return clicked;
}

int dialog_buttons(GuiFrame& frame, const char* id, std::initializer_list<const char*> labels, int escape,
                   bool enter) {
    float width = -px(8);
    for (const char* label : labels) width += button_width(label, least_button) + px(8);
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - width);
    int chosen = dialog_escape() ? escape : -1, index = 0;
    for (const char* label : labels) {
        const bool is_default = index + 1 == static_cast<int>(labels.size());
        if (index > 0) ImGui::SameLine(0, px(8));
        if (dialog_button(label, is_default, least_button)) chosen = index;
        note_item(frame, std::string(id) + "/" + label);
        if (is_default && enter && enter_answers() && !ImGui::IsWindowAppearing()) chosen = index;
        ++index;
    }
    return chosen;
}

namespace {

constexpr float name_width = 112, choice_height = 26, sheet_row = 20;

// Returns where what is set comes.
ImVec2 setting_name(const char* name, const char* hint) {
    const float left = ImGui::GetCursorScreenPos().x;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(color4(color::dim), "%s", name);
    tooltip(hint);
    ImGui::SameLine();
    return {left + px(name_width), ImGui::GetCursorScreenPos().y};
}

void setting_row(GuiFrame& frame, const SettingRow& row) {
    int& value = frame.view.settings.*row.value;
    const ImVec2 corner = setting_name(row.label, row.hint);
    float x = corner.x;
    for (const SettingChoice& choice : row.choices) {
        ImGui::SetCursorScreenPos({x, corner.y});
        const int chosen = value == choice.value ? 0 : -1;
        const std::initializer_list<Segment> segment{{choice.label, row.hint}};
        if (segmented(frame, std::string("settings/") + row.name, segment, chosen, choice_height) >= 0)
            value = choice.value;
        x += segmented_width(segment) + px(2);
    }
    ImGui::SetCursorScreenPos({corner.x - px(name_width), corner.y + px(choice_height + 8)});
}

void cache_folder_row(GuiFrame& frame) {
    std::string& folder = frame.view.settings.cache_folder;
    const char* const hint =
        "Where generated sets are kept, from the next start; --cache and $ASTROSPLAT_CACHE win";
    const ImVec2 corner = setting_name("Cache folder", hint);
    ImGui::SetCursorScreenPos(corner);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    const std::string automatic = "Auto: " + default_cache_folder().string();
    ImGui::InputTextWithHint("##cache_folder", automatic.c_str(), &folder);
    note_item(frame, "settings/cache_folder");
    tooltip(hint);
    // As high whatever it says, or the button below would move.
    const std::string problem = problem_of_cache_folder(folder);
    ImGui::SetCursorScreenPos({corner.x, ImGui::GetCursorScreenPos().y});
    ImGui::TextColored(color4(color::error), "%s", problem.empty() ? " " : problem.c_str());
    ImGui::SetCursorScreenPos({corner.x - px(name_width), ImGui::GetCursorScreenPos().y});
}

struct SheetRow {
    std::string does, shortcut;
};
struct Group {
    std::string title;
    std::vector<SheetRow> rows;
};

// Besides the shortcuts of actions.
const std::vector<Group>& mouse_groups() {
    static const std::vector<Group> groups{{"Mouse in the view",
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
                                             {"As in Maya and Houdini", "Alt+Left, Middle, Right"}}},
                                           {"Values",
                                            {{"Change", "Drag"},
                                             {"Coarse, fine", "Shift, Alt"},
                                             {"Type", "Double click"},
                                             {"Reset, keyframe, copy, paste", "Right click"}}},
                                           {"Keyboard",
                                            {{"Next control, the one before", "Tab, Shift+Tab"},
                                             {"Panel, tools, timeline", "F6"},
                                             {"Use, type into", "Space, Enter"},
                                             {"Back to the timeline", "Esc"},
                                             {"Menus", "F10, Alt, Alt+letter"}}},
                                           {"Timeline",
                                            {{"Move keyframes", "Drag"},
                                             {"Copy keyframes", "Ctrl+drag"},
                                             {"Select more", "Shift+click, box"},
                                             {"Remove keyframes", "Del"},
                                             {"Zoom", "Wheel on the ruler"},
                                             {"Zoom and move the graph", "Wheel, Middle"},
                                             {"Break a handle", "Alt+drag"}}}};
    return groups;
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
    for (const SheetRow& row : group.rows) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float shortcut_width = ImGui::CalcTextSize(row.shortcut.c_str()).x;
        draw_text(at, color::dim, fitting(row.does, room - shortcut_width - px(12)));
        draw_text({at.x + room - shortcut_width, at.y}, color::text, row.shortcut);
        ImGui::Dummy({room, px(sheet_row)});
    }
    ImGui::Dummy({0, px(8)});
}

}  // namespace

void draw_settings_dialog(GuiFrame& frame) {
    if (!begin_dialog("settings", "Settings", frame.view.settings_open, 580, 0)) return;
    for (const SettingRow& row : setting_rows()) setting_row(frame, row);
    cache_folder_row(frame);
    ImGui::Dummy({0, px(8)});
    const bool done = dialog_buttons(frame, "settings", {"Done"}, 0) == 0;
    if (done) request(frame, Command::Kind::keep_settings);
    frame.view.settings_open = !done;
    end_dialog(done);
}

void draw_shortcut_sheet(GuiFrame& frame) {
    bool& open = frame.view.help_open;
    if (!begin_dialog("shortcuts", "Shortcuts and mouse", open, 1040, 656)) return;
    const float bottom = px(40);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(28), 0));
    ImGui::BeginChild("groups", {0, ImGui::GetContentRegionAvail().y - bottom}, false,
                      ImGuiWindowFlags_NoScrollbar);
    const float column = (ImGui::GetContentRegionAvail().x - 2 * px(28)) / 3;
    const std::array<std::vector<Group>, 3> columns{
        {mouse_groups(),
         {group_of("View", {"View", "View/Channels and scopes"}), group_of("Layer", {"Layer"})},
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
    const bool closes = dialog_buttons(frame, "shortcuts", {"Close"}, 0) == 0;
    open = !closes && (!key_pressed(key_code::f1) || ImGui::IsWindowAppearing());
    end_dialog(!open);
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
    const int button = dialog_buttons(frame, "log", {"Copy all", "Close"}, 1);
    if (button == 0) {
        std::string text;
        for (const Message& message : frame.status.log) text += message.text + "\n";
        request_text(frame, Command::Kind::copy_text, text);
    }
    if (button == 1) open = false;
    end_dialog(!open);
}

void begin_move(GuiFrame& frame, CameraMove move) {
    if (camera_keyframes_after(frame.document.scene(), frame.view.frame) > 0) {
        frame.view.asked_move = move;
        return;
    }
    request(frame, Command::Kind::add_move, static_cast<std::size_t>(move));
}

void draw_move_dialog(GuiFrame& frame) {
    std::optional<CameraMove>& move = frame.view.asked_move;
    const char* const name = camera_move_names[static_cast<std::size_t>(move.value_or(CameraMove::orbit))];
    const std::string title = fmt::format("{} from frame {:g}", name, frame.view.frame);
    if (!begin_dialog("move", title, move.has_value(), 460, 0)) return;
    const std::size_t later = camera_keyframes_after(frame.document.scene(), frame.view.frame);
    const std::string note =
        fmt::format("The camera has keyframes at {} later {}.", later, later == 1 ? "frame" : "frames");
    dialog_note(note.c_str(), 4);
    constexpr std::array<const char*, 3> choices{"Keep those after the end of the move",
                                                 "Shift them to after the move", "Replace them by the move"};
    constexpr std::array<const char*, 3> words{"keep", "shift", "replace"};
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const auto choice = static_cast<LaterKeys>(i);
        if (ImGui::RadioButton(choices[i], frame.view.later_keys == choice)) frame.view.later_keys = choice;
        note_item(frame, std::string("move/") + words[i]);
    }
    ImGui::Dummy({0, px(8)});
    const int button = dialog_buttons(frame, "move", {"Cancel", "Add"}, 0);
    if (button == 1) request(frame, Command::Kind::add_move, static_cast<std::size_t>(*move));
    if (button >= 0) move.reset();
    end_dialog(button >= 0);
}

}  // namespace astrosplat
