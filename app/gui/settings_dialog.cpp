// The dialog of the settings: a row each from setting_rows(), and the folder of the cache.
#include "gui/parts.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "gui/dialog.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float name_width = 112, choice_height = 26;

void draw_row(GuiFrame& frame, const SettingRow& row) {
    const float left = ImGui::GetCursorScreenPos().x;
    int& value = frame.view.settings.*row.value;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(color4(color::dim), "%s", row.label);
    tooltip(row.hint);
    ImGui::SameLine();
    const ImVec2 corner{left + px(name_width), ImGui::GetCursorScreenPos().y};
    float x = corner.x;
    for (const SettingChoice& choice : row.choices) {
        const std::string id = std::string(row.name) + "/" + choice.label;
        ImGui::SetCursorScreenPos({x, corner.y});
        const int chosen = value == choice.value ? 0 : -1;
        const std::initializer_list<Segment> segment{{choice.label, row.hint}};
        const float width = segmented_width(segment);
        if (segmented(id.c_str(), segment, chosen, px(choice_height), nullptr) >= 0) value = choice.value;
        note_item(frame, "settings/" + id, {x + 0.5f * width, corner.y + 0.5f * px(choice_height)});
        x += width + px(2);
    }
    ImGui::SetCursorScreenPos({left, corner.y + px(choice_height + 8)});
}

void cache_folder_row(GuiFrame& frame) {
    const float left = ImGui::GetCursorScreenPos().x;
    std::string& folder = frame.view.settings.cache_folder;
    const char* const hint =
        "Where generated sets are kept, from the next start; --cache and $ASTROSPLAT_CACHE win";
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(color4(color::dim), "Cache folder");
    tooltip(hint);
    ImGui::SameLine();
    ImGui::SetCursorScreenPos({left + px(name_width), ImGui::GetCursorScreenPos().y});
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    const std::string automatic = "Auto: " + default_cache_folder().string();
    ImGui::InputTextWithHint("##cache_folder", automatic.c_str(), &folder);
    note_item(frame, "settings/cache_folder");
    tooltip(hint);
    // As high whatever it says, or the button below would move.
    const std::string problem = problem_of_cache_folder(folder);
    ImGui::SetCursorScreenPos({left + px(name_width), ImGui::GetCursorScreenPos().y});
    ImGui::TextColored(color4(color::error), "%s", problem.empty() ? " " : problem.c_str());
    ImGui::SetCursorScreenPos({left, ImGui::GetCursorScreenPos().y});
}

}  // namespace

void draw_settings_dialog(GuiFrame& frame) {
    if (!begin_dialog("settings", "Settings", frame.view.settings_open, 580, 0)) return;
    for (const SettingRow& row : setting_rows()) draw_row(frame, row);
    cache_folder_row(frame);
    ImGui::Dummy({0, px(8)});
    if (dialog_buttons(frame, "settings", {"Done"}, true) >= 0 || dialog_escape()) {
        frame.view.settings_open = false;
        request(frame, Command::Kind::keep_settings);
        ImGui::CloseCurrentPopup();
    }
    end_dialog();
}

}  // namespace astrosplat
