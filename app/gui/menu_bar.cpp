// The menus: a loop over actions(), with recent files and the history added where File > Open
// and Edit > Redo are.
#include "gui/parts.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "gui/actions.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

void recent_files(GuiFrame& frame) {
    const bool any = !frame.status.recent.empty();
    if (ImGui::BeginMenu("Open recent", any)) {
        for (const auto& file : frame.status.recent) {
            ImGui::PushID(file.c_str());  // two of one name are two
            if (ImGui::MenuItem(file.filename().string().c_str()))
                request_path(frame, Command::Kind::open, file);
            note_item(frame, "File/Open recent/" + file.filename().string());
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.string().c_str());
            ImGui::PopID();
        }
        ImGui::EndMenu();
    } else {
        note_item(frame, "File/Open recent");
    }
}

// The steps of the document, the newest at the top; a click goes there. What can be redone is dimmed.
void history(GuiFrame& frame) {
    constexpr std::size_t most_seen = 30;
    if (!ImGui::BeginMenu("History")) return note_item(frame, "Edit/History");
    const std::vector<std::string> names = frame.document.history();
    const std::size_t now = frame.document.history_place();
    const std::size_t last = std::min(names.size(), std::max(now + most_seen / 2, most_seen));
    for (std::size_t step = last; step-- > last - std::min(last, most_seen);) {
        ImGui::PushID(static_cast<int>(step));
        ImGui::PushStyleColor(ImGuiCol_Text, step > now ? color::dim : color::text);
        const std::string& name = step == 0 ? "As opened" : names[step];
        if (ImGui::MenuItem(name.c_str(), nullptr, step == now)) frame.document.go_to(step);
        note_item(frame, "Edit/History/" + std::to_string(step));
        ImGui::PopStyleColor();
        ImGui::PopID();
    }
    ImGui::EndMenu();
}

void draw_action(GuiFrame& frame, const Action& action) {
    if (action.line_above) ImGui::Separator();
    const std::string label = action.label_now ? action.label_now(frame) : action.label;
    const bool enabled = !action.enabled || action.enabled(frame);
    const bool checked = action.checked && action.checked(frame);
    if (ImGui::MenuItem(label.c_str(), shortcut_text(action.shortcut).c_str(), checked, enabled))
        action.run(frame);
    note_item(frame, std::string(action.menu) + "/" + action.label);
    if (std::string_view(action.label) == "Open...") recent_files(frame);
    if (std::string_view(action.label) == "Redo") history(frame);
}

// Actions of one submenu follow each other in the table; it opens where the first of them stands.
void draw_submenu(GuiFrame& frame, const std::string& path) {
    const std::string title = path.substr(path.find('/') + 1);
    const bool open = ImGui::BeginMenu(title.c_str());
    if (!open) return note_item(frame, path);
    for (const Action& action : actions())
        if (path == action.menu) draw_action(frame, action);
    ImGui::EndMenu();
}

void draw_menu(GuiFrame& frame, const char* menu) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(12), px(8)));
    const bool open = ImGui::BeginMenu(menu);
    // While it is open the last item is one of the menu's own.
    if (!open) note_item(frame, menu);
    if (open) {
        std::string submenu;
        for (const Action& action : actions()) {
            const std::string path = action.menu;
            if (path == menu) draw_action(frame, action);
            if (path.rfind(std::string(menu) + "/", 0) == 0 && path != submenu)
                draw_submenu(frame, submenu = path);
        }
        close_on_escape();
        ImGui::EndMenu();
    }
    ImGui::PopStyleVar(2);
}

void draw_title(const GuiFrame& frame, const Rect& area) {
    const std::string name = frame.document.name();
    const std::string text = frame.document.edited() ? name + " - edited" : name;
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float x = std::max(area.x + (area.width - size.x) * 0.5f, ImGui::GetCursorScreenPos().x + px(12));
    draw_text({std::floor(x), area.y + std::floor((area.height - size.y) * 0.5f)},
              frame.document.edited() ? color::text : color::dim, text);
}

}  // namespace

void draw_menu_bar(GuiFrame& frame, const Rect& area) {
    const float padding = (area.height - ImGui::GetFontSize()) * 0.5f;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), padding));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(16), px(4)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), 0));
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::BeginChild("menu", {area.width, area.height}, false, ImGuiWindowFlags_MenuBar);
    if (ImGui::BeginMenuBar()) {
        for (const char* menu : {"File", "Edit", "View", "Layer", "Camera", "Render", "Help"})
            draw_menu(frame, menu);
        draw_title(frame, area);
        ImGui::EndMenuBar();
    }
    ImGui::EndChild();
    ImGui::PopStyleVar(3);
}

}  // namespace astrosplat
