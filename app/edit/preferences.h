// Settings of the window that are kept between sessions: sizes, recent files and folders, nothing that
// reaches a scene or a frame. A small JSON file in the person's configuration folder.
#pragma once

#include "edit/view_state.h"

namespace astrosplat {

struct Preferences : PanelSizes {
    static constexpr std::size_t most_recent_files = 12, most_recent_folders = 8;
    int window_width = 1600, window_height = 900;  // px at scale 1
    std::vector<fs::path> recent;                  // newest first, absolute
    bool operator==(const Preferences&) const = default;
};

/// config_folder()/viewer.json; empty without a home.
fs::path preferences_file();

/// Values that are missing, of another type or out of range have their defaults, recent files and
/// folders that are gone are left out. A damaged file gives the defaults and one warning;
/// a missing one is no news.
Preferences load_preferences(const fs::path& file = preferences_file());
/// Atomically. A file that cannot be written costs one warning.
void save_preferences(const Preferences& preferences, const fs::path& file = preferences_file());

/// `file` becomes the first of the recent ones.
void add_recent(Preferences& preferences, const fs::path& file);
/// `folder` becomes the first of the recent ones.
void add_recent_folder(PanelSizes& window, const fs::path& folder);

}  // namespace astrosplat
