// prepare: a picture made ready for a scene: without its stars and its sky, cut out, its holes filled. Prints
// results to stdout, everything else to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "exit_code.h"
#include "progress_report.h"

namespace astrosplat {

/// As typed; values are checked before any work.
struct PrepareOptions {
    std::filesystem::path image, folder;
    std::filesystem::path red, green, blue;       // three filters in place of the image
    std::map<std::string, std::string> settings;  // by key of describe_preparation()
    std::optional<std::filesystem::path> split;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_prepare(const PrepareOptions& options);

}  // namespace astrosplat
