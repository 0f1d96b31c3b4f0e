// The frame of every dialog: centred, with a title, closed by Escape, its buttons at the lower right.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

/// Begins a modal dialog `width` px wide at scale 1 (`height` 0: as high as its content). `id` is opened when
/// `open` turns true. True while it is shown; then call end_dialog().
bool begin_dialog(const char* id, const std::string& title, bool open, float width, float height);
void end_dialog();

/// A quiet line below the title, `gap` px at scale 1 above what follows.
void dialog_note(const char* text, float gap);

/// Escape was pressed in the dialog, with no text field to leave first.
bool dialog_escape();

/// Buttons at the right of the line, from left to right, the last one the default (Enter): index of the one
/// chosen, else -1.
int dialog_buttons(GuiFrame& frame, const char* id, std::initializer_list<const char*> labels, bool enter);

}  // namespace astrosplat
