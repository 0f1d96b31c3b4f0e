// The parts tabs are made of, besides rows: folding sections, small heads, notes, buttons.
#pragma once

#include <string>

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// Head of a folding section, with its state at the right while it is closed. True when open.
bool section(Context& context, const char* title, const std::string& state, bool open_at_first = false);

/// Head of one element of a list; true when its cross was clicked.
bool element_head(const char* title);

/// ImGui's popup with the room of a menu between its items; end_popup only after true.
bool begin_popup(const char* id);
void end_popup();

/// A line or more of small, quiet text.
void note(const std::string& text);
void note(const std::string& text, ImU32 color);

/// A button as wide as `width` (0: as its text). True when clicked.
bool text_button(const char* label, float width = 0.0f);

/// Buttons that share one line evenly: index of the one clicked, -1 none.
int button_line(std::initializer_list<const char*> labels);

/// A quiet "+ label" that adds an element to a list; true when clicked.
bool add_line(const char* label);

/// A bar with text over it, and a button at its right; true when the button was clicked. A share of 0 is no
/// progress but something that waits for the button.
bool progress_line(float width, float share, const std::string& text, const char* button);

}  // namespace astrosplat::panel
