// A field for one value: dragging changes a number, a double click types it. Draws the faint fill and the
// unit; knows nothing of parameters.
#pragma once

#include <string>

#include "gui/panel/context.h"

namespace astrosplat::panel {

struct Area {
    ImVec2 corner, size;
    ImVec2 end() const { return {corner.x + size.x, corner.y + size.y}; }
    ImVec2 middle() const { return {corner.x + size.x * 0.5f, corner.y + size.y * 0.5f}; }
};

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

BoxEvent value_box(Context& context, const char* id, const Area& area, const BoxContent& content);

/// Whether a box of this size shows all of the text, without a unit.
bool fits_box(const Area& area, const std::string& text);

/// Text at the left, ended by "..." where it is too long; returns its width.
float clipped_text(ImDrawList* list, const Area& area, float padding, ImU32 color, const std::string& text);

/// The small font: unit at the right edge; returns the room it took, 0 where there was not enough.
float unit_text(ImDrawList* list, const Area& area, const std::string& unit, float needed);

}  // namespace astrosplat::panel
