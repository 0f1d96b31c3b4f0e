// prepare: a picture made ready for a scene: without its stars and its sky, cut out, its holes filled. Prints
// results to stdout, everything else to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "exit_code.h"
#include "progress_report.h"

namespace astrosplat {

/// As typed; numbers and lists of them are checked before any work.
struct PrepareOptions {
    std::filesystem::path image, folder;
    std::filesystem::path red, green, blue;  // three filters in place of the image
    std::optional<std::string> threshold, saturation;
    std::optional<std::string> stretch;           // of FITS
    std::optional<std::string> q, lupton;         // of three filters: Lupton's Q and stretch
    std::optional<std::string> background;        // level, plane or curved
    std::optional<std::string> ellipse, feather;  // X,Y,RX,RY[,ANGLE] in px and degrees; share of the radii
    std::optional<std::string> alpha;             // LOW,HIGH luminance
    std::optional<std::filesystem::path> mask, holes, split;
    bool keep_stars = false;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_prepare(const PrepareOptions& options);

}  // namespace astrosplat
