// Dialogs' frame.
#include "gui/dialog.h"

#include <imgui.h>

#include <algorithm>

#include "gui/key_codes.h"
#include "gui/theme.h"
#include "gui/widgets.h"

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
        if (is_default && enter && (pressed(key_code::enter) || pressed(key_code::pad_enter))) chosen = index;
        ++index;
    }
    return chosen;
}

}  // namespace astrosplat
