// One row of the file dialog, and the columns above them that say the order. In: what a row says. Out:
// clicks.
#pragma once

#include <cstdint>
#include <string>

#include "edit/status.h"
#include "gui/file_list.h"
#include "gui/gui_frame.h"
#include "gui/icons.h"

namespace astrosplat {

inline constexpr float file_row_height = 26, picture_row_height = 54;  // px at scale 1

struct FileClick {
    bool once = false, twice = false;
};

struct FileRow {
    Icon icon = Icon::file;
    std::string text;
    bool chosen = false;
    std::string time{}, size{};                  // in columns of their own, both or none
    bool high = false;                           // among pictures: there is room for one in place of the icon
    bool picture = false;                        // it is one, and black until it is seen
    const ListedThumbnail* thumbnail = nullptr;  // of a picture; null: not read yet
};

/// As wide as there is room.
FileClick file_row(const char* id, const FileRow& row);

/// The columns' names over rows `room` px wide. True when one was clicked, which changes the order, or the
/// same one backwards.
bool draw_file_columns(GuiFrame& frame, float room, FileOrder& order, bool& backwards);

/// "1.2 MB".
std::string size_text(std::uintmax_t bytes);

}  // namespace astrosplat
