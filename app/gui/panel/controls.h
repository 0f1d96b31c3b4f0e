// What the panel is made of besides the rows of parameters: a field for one value, which knows nothing of
// parameters; folding sections, small heads, notes, buttons; texts within rectangles.
#pragma once

#include <initializer_list>
#include <string>

#include "gui/panel/context.h"
#include "gui/theme.h"

namespace astrosplat::panel {

inline constexpr float row_height = 24.0f, row_space = 2.0f;  // px at scale 1

// A field: dragging changes a number, a double click types it. Draws the faint fill and the unit.

struct BoxContent {
    std::string shown, unit;
    std::string typed;   // what typing begins with
    double value = 0.0;  // what dragging begins with
    double step = 0.0;   // per px of dragging; 0: cannot be dragged
    double min = 0.0, max = 0.0;
    bool whole = false;   // whole numbers
    float fill = -1.0f;   // 0..1 of the width; below 0: none
    bool dimmed = false;  // not set: "Auto"
};

struct BoxEvent {
    enum class Kind { none, dragged, typed } kind = Kind::none;
    double value = 0.0;
    std::string text;
};

BoxEvent value_box(Context& context, const char* id, const Rect& area, const BoxContent& content);

/// Whether a box of this size shows all of the text, without a unit.
bool fits_box(const Rect& area, const std::string& text);

/// Where the mouse is from left to right, 0..1.
float share_at_mouse(const Rect& area);

/// Text at the left, ended by "..." where it is too long; returns its width.
float clipped_text(const Rect& area, float padding, ImU32 color, const std::string& text);

/// Head of a folding section, with its state at the right while it is closed. True when open.
bool section(Context& context, const char* title, const std::string& state, bool open_at_first = false);

/// Head of one element of a list; true when its cross was clicked.
bool element_head(const char* title);

/// ImGui's popup with the room of a menu between its items; end_menu_popup (widgets.h) only after true.
bool begin_popup(const char* id);

/// A line or more of small, quiet text.
void note(const std::string& text, ImU32 ink = color::dim);

/// A button as wide as `width` (0: as its text). True when clicked.
bool text_button(const char* label, float width = 0.0f);

/// Buttons that share one line evenly, remembered as "panel/LABEL": index of the one clicked, -1 none.
int button_line(Context& context, std::initializer_list<const char*> labels);

/// A quiet "+ label" that adds an element to a list; true when clicked.
bool add_line(const char* label);

/// A bar with text over it, and a button at its right; true when the button was clicked. A share of 0 is no
/// progress but something that waits for the button.
bool progress_line(float width, float share, const std::string& text, const char* button);

}  // namespace astrosplat::panel
