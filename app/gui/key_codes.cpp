// Key numbers to ImGui's map and to the words on keycaps.
#include "gui/key_codes.h"

#include <imgui.h>

#include <array>

namespace astrosplat {

void set_key_map() {
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

const char* key_name(int key) {
    switch (key) {
        case 0:
            return "";
        case key_code::space:
            return "Space";
        case key_code::escape:
            return "Esc";
        case key_code::tab:
            return "Tab";
        case key_code::del:
            return "Del";
        case key_code::right:
            return "Right";
        case key_code::left:
            return "Left";
        case key_code::down:
            return "Down";
        case key_code::up:
            return "Up";
        case key_code::home:
            return "Home";
        case key_code::end:
            return "End";
        case key_code::f1:
            return "F1";
        case key_code::f11:
            return "F11";
        case key_code::f12:
            return "F12";
        default:
            break;
    }
    // Letters and digits are their own names.
    static const auto names = [] {
        std::array<std::array<char, 2>, 128> table{};
        for (std::size_t i = 0; i < table.size(); ++i) table[i][0] = static_cast<char>(i);
        return table;
    }();
    return key > 0 && key < 128 ? names[static_cast<std::size_t>(key)].data() : "";
}

}  // namespace astrosplat
