// Key codes to the words on keycaps.
#include "gui/key_codes.h"

#include <imgui.h>

#include <map>

namespace astrosplat {

namespace {

std::string key_name(int code) {
    using namespace key_code;
    static const std::map<int, std::string> words = {
        {0, ""},          {space, "Space"}, {escape, "Esc"}, {tab, "Tab"}, {del, "Del"},
        {right, "Right"}, {left, "Left"},   {down, "Down"},  {up, "Up"},   {home, "Home"},
        {end, "End"},     {f1, "F1"},       {f11, "F11"},    {f12, "F12"}};
    if (const auto word = words.find(code); word != words.end()) return word->second;
    return code > 0 && code < 128 ? std::string(1, static_cast<char>(code)) : "";  // letters and digits
}

}  // namespace

bool key_pressed(int code, bool repeats) { return ImGui::IsKeyPressed(static_cast<ImGuiKey>(code), repeats); }

bool key_down(int code) { return ImGui::IsKeyDown(static_cast<ImGuiKey>(code)); }

bool shortcut_pressed(const Shortcut& s, bool repeats) {
    const ImGuiIO& io = ImGui::GetIO();
    if (s.code == 0 || io.KeyAlt || io.KeyCtrl != s.ctrl || io.KeyShift != s.shift) return false;
    return key_pressed(s.code, repeats);
}

std::string shortcut_text(const Shortcut& s) {
    return std::string(s.ctrl ? "Ctrl+" : "") + (s.shift ? "Shift+" : "") + key_name(s.code);
}

}  // namespace astrosplat
