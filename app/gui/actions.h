// Everything a menu or a shortcut does, once: the menus, the shortcuts and the sheet of shortcuts are loops
// over this table. The row of tools does the same to the view by the functions below it.
#pragma once

#include <span>
#include <string>

#include "gui/gui_frame.h"
#include "gui/key_codes.h"

namespace astrosplat {

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

/// Runs the shortcuts pressed this frame. Call it only while no text is typed and nothing is dragged.
void run_shortcuts(GuiFrame& frame);

void toggle_one_to_one(GuiFrame& f);
void set_compare(GuiFrame& f, CompareMode mode);   // asks for a reference where there is none yet
void compare_with(GuiFrame& f, CompareWith with);  // likewise
bool compares_with_reference(const GuiFrame& f);
bool has_reference(const GuiFrame& f);
void toggle_placing(GuiFrame& f);

}  // namespace astrosplat
