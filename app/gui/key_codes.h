// Codes of the keyboard's keys that ImGui does not name itself, as they index ImGuiIO::KeysDown, also in
// versions that have an enumeration of their own (1.87). They are GLFW's: letters and digits are their ASCII
// codes. Written out so that the widgets need no window library.
#pragma once

#include <string>

namespace astrosplat {

namespace key_code {
inline constexpr int space = 32, n0 = 48, n1 = 49, n3 = 51, n7 = 55, n9 = 57;
inline constexpr int escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, del = 261;
inline constexpr int right = 262, left = 263, down = 264, up = 265;
inline constexpr int page_up = 266, page_down = 267, home = 268, end = 269;
inline constexpr int f1 = 290, f11 = 300, f12 = 301;
inline constexpr int pad_enter = 335;
}  // namespace key_code

/// Whether the key went down in this frame, also by holding it where that `repeats`; whether it is down.
bool key_pressed(int code, bool repeats = false);
bool key_down(int code);

struct Shortcut {
    int code = 0;  // 0: none
    bool ctrl = false, shift = false;
};
/// As key_pressed, with these modifiers and no others.
bool shortcut_pressed(const Shortcut& shortcut, bool repeats);
/// "Ctrl+Shift+S", for menus and the sheet of shortcuts; "" for none.
std::string shortcut_text(const Shortcut& shortcut);

}  // namespace astrosplat
