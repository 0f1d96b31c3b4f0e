// Settings of the window that do not depend on the scene: size and contrast of text, threads, memory, cache,
// autosave, how a view begins. One table feeds the dialog and the file of preferences; nothing of it reaches
// a frame, but for a limit of memory, which acts as a smaller machine does.
#pragma once

#include "render/device.h"
#include "sets/kept.h"

namespace astrosplat {

struct Settings {
    int interface_percent = 0;      // of the size at scale 1; 0: as the screen asks
    int contrast = 0;               // 1: high
    int threads = 0;                // 0: the cores this process may use
    int memory_gib = 0;             // most that the window takes; 0: what is free
    int cache_gib = 0;              // most that generated sets may take; 0: 20 GiB or a tenth of the disk
    int frames_gib = 0;             // most that kept final frames may take; 0: 2 GiB; -1: none is kept
    int autosave_s = 60;            // from an edit to the copy that survives a crash
    int settles = 1;                // 0: views begin without going on to the final frame
    int engine = 0;                 // a PreviewEngine, with which views begin
    int device = 0;                 // a DeviceChoice, of final frames and jobs
    std::string cache_folder = {};  // absolute; empty: as default_cache_folder() has it
    bool operator==(const Settings&) const = default;
};

/// What the window and each of its jobs have of the machine.
struct MachineLimits {
    int threads = 0;     // 0: the cores this process may use
    int memory_gib = 0;  // 0: what is free
    DeviceChoice device = DeviceChoice::automatic;
    bool operator==(const MachineLimits&) const = default;
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

/// All but the folder.
std::span<const SettingRow> setting_rows();

/// Why this cannot be the cache's folder: "expected an absolute path, found 'x'"; empty: it can.
std::string problem_of_cache_folder(const std::string& folder);

/// Those of the settings, but for --threads and --device where the command line has them (0, automatic: it
/// has not).
MachineLimits limits_with(const Settings& settings, int threads_given,
                          DeviceChoice device_given = DeviceChoice::automatic);
/// As words of a command: "--threads=4".
std::vector<std::string> limit_arguments(const MachineLimits& limits);

/// The window's cache: `asked` where the command line (`given`) or the environment names one, else that of
/// the settings; never larger than these say.
SetCache cache_with(const Settings& settings, const SetCache& asked, bool given);

}  // namespace astrosplat
