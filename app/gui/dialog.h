// The frame of every dialog: centred, with a title, closed by Escape, its buttons at the lower right.
#pragma once

#include <initializer_list>
#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

/// Begins a modal dialog `width` px wide at scale 1 (`height` 0: as high as its content). `id` is opened when
/// `open` turns true. True while it is shown; then call end_dialog().
bool begin_dialog(const char* id, const std::string& title, bool open, float width, float height);
/// `closes`: it is not to be seen any more, and `open` will be false.
void end_dialog(bool closes);

/// A quiet line below the title, `gap` px at scale 1 above what follows.
void dialog_note(const char* text, float gap);

/// A button as wide as its text and at least `least` px; the accent for what Enter would do.
bool dialog_button(const char* label, bool is_default, float least);

/// Escape was pressed in the dialog, with no text field to leave first.
bool dialog_escape();

/// Buttons at the right of the line, from left to right: index of the one chosen, else -1. Escape chooses the
/// one of index `escape` (-1: none); Enter, where it is taken, the last one.
int dialog_buttons(GuiFrame& frame, const char* id, std::initializer_list<const char*> labels, int escape,
                   bool enter = true);

}  // namespace astrosplat
