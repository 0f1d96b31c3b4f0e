// --batch: renders frames without a window. Prints results to stdout, everything else to stderr, and returns
// the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exit_code.h"
#include "progress_report.h"
#include "sets/kept.h"

namespace astrosplat {

struct BatchOptions {
    std::filesystem::path scene;
    std::vector<std::string> assignments;   // --set KEY=VALUE
    std::optional<std::string> frames;      // replaces output.frames
    std::optional<std::string> output;      // replaces output.path; relative to the working directory
    std::optional<std::string> resolution;  // "1920x1080" or "50%"
    std::optional<std::string> layers;      // "A,B": only these
    std::optional<std::string> region;      // "X,Y,W,H" from the top left, px
    std::optional<std::string> memory_gib;  // limit of all that is taken
    std::optional<std::filesystem::path> stats;
    SetCache cache;
    bool resume = false, overwrite = false, dry_run = false;
    bool sets_only = false;  // generates and keeps the sets, and renders nothing
    ProgressMode progress = ProgressMode::automatic;
};
int run_batch(const BatchOptions& options);

}  // namespace astrosplat
