// One row of the file dialog, and the columns above them that say the order. In: what a row says. Out:
// clicks.
#pragma once

#include <cstdint>
#include <string>

#include "gui/file_list.h"
#include "gui/gui_frame.h"
#include "gui/icons.h"

namespace astrosplat {

inline constexpr float file_row_height = 26;  // px at scale 1

struct FileClick {
    bool once = false, twice = false;
};

/// A row as wide as there is room; `time` and `size` stand in columns of their own, or are empty.
FileClick file_row(const char* id, Icon icon, const std::string& text, bool chosen,
                   const std::string& time = "", const std::string& size = "");

/// The columns' names. True when one was clicked, which changes the order, or the same one backwards.
bool draw_file_columns(GuiFrame& frame, FileOrder& order, bool& backwards);

/// "1.2 MB".
std::string size_text(std::uintmax_t bytes);

}  // namespace astrosplat
