// What a person sets for the window, whatever the scene: size of text, threads, cache, autosave, how a view
// begins. One table feeds the dialog and the file of preferences; nothing of it reaches a picture.
#pragma once

#include <span>

namespace astrosplat {

struct Settings {
    int interface_percent = 0;  // of the size at scale 1; 0: as the screen asks
    int threads = 0;            // 0: the cores this process may use
    int cache_gib = 0;          // most that generated sets may take; 0: 20 GiB or a tenth of the disk
    int autosave_s = 60;        // from an edit to the copy that survives a crash
    int settles = 1;            // 0: views begin without going on to the final frame
    int engine = 0;             // a PreviewEngine, with which views begin
    bool operator==(const Settings&) const = default;
};

struct SettingChoice {
    int value;
    const char* label;
};

struct SettingRow {
    const char* name;  // in the file
    const char* label;
    const char* hint;
    int Settings::*value;
    std::span<const SettingChoice> choices;
};

std::span<const SettingRow> setting_rows();

}  // namespace astrosplat
