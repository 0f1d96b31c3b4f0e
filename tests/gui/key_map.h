// Which keys the tests' ImGui knows by which codes: the window library's.
#pragma once

#include <imgui.h>

#include "gui/widgets.h"

namespace astrosplat {

// As the window library's backend tells ImGui which are its own keys.
inline void set_key_map() {
    int* map = ImGui::GetIO().KeyMap;
    map[ImGuiKey_Tab] = key_code::tab;
    map[ImGuiKey_LeftArrow] = key_code::left;
    map[ImGuiKey_RightArrow] = key_code::right;
    map[ImGuiKey_UpArrow] = key_code::up;
    map[ImGuiKey_DownArrow] = key_code::down;
    map[ImGuiKey_PageUp] = key_code::page_up;
    map[ImGuiKey_PageDown] = key_code::page_down;
    map[ImGuiKey_Home] = key_code::home;
    map[ImGuiKey_End] = key_code::end;
    map[ImGuiKey_Insert] = key_code::insert;
    map[ImGuiKey_Delete] = key_code::del;
    map[ImGuiKey_Backspace] = key_code::backspace;
    map[ImGuiKey_Space] = key_code::space;
    map[ImGuiKey_Enter] = key_code::enter;
    map[ImGuiKey_Escape] = key_code::escape;
    map[ImGuiKey_KeyPadEnter] = key_code::pad_enter;
    map[ImGuiKey_A] = 'A';
    map[ImGuiKey_C] = 'C';
    map[ImGuiKey_V] = 'V';
    map[ImGuiKey_X] = 'X';
    map[ImGuiKey_Y] = 'Y';
    map[ImGuiKey_Z] = 'Z';
}

}  // namespace astrosplat
