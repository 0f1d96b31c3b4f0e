// prepare: a picture without its stars, and the stars as a table. Prints results to stdout, everything else
// to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "exit_code.h"
#include "progress_report.h"

namespace astrosplat {

struct PrepareOptions {
    std::filesystem::path image, folder;
    std::optional<std::string> threshold, saturation;  // numbers
    std::optional<std::string> stretch;                // of FITS
    bool keep_stars = false;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_prepare(const PrepareOptions& options);

}  // namespace astrosplat
