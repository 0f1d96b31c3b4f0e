// Everything a menu or a shortcut does, once: the menus, the shortcuts and the sheet of shortcuts are loops
// over this table.
#pragma once

#include <span>
#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

struct Shortcut {
    int code = 0;  // key_codes.h; 0: none
    bool ctrl = false, shift = false;
};

struct Action {
    const char* menu;  // "File"; "Camera/Add move" for a submenu; "" where only the shortcut does it
    const char* label;
    Shortcut shortcut = {};
    void (*run)(GuiFrame&);
    bool (*enabled)(const GuiFrame&) = nullptr;           // nullptr: always
    bool (*checked)(const GuiFrame&) = nullptr;           // nullptr: not a switch
    std::string (*label_now)(const GuiFrame&) = nullptr;  // in place of label where it says more
    bool line_above = false;
    bool repeats = false;  // while it is held
    Shortcut also = {};    // does the same
};

/// In the order of the menus.
std::span<const Action> actions();

/// "Ctrl+Shift+S"; "" for none.
std::string shortcut_text(const Shortcut& shortcut);

/// Runs the shortcuts pressed this frame. Call it only while no text is typed and nothing is dragged.
void run_shortcuts(GuiFrame& frame);

}  // namespace astrosplat
