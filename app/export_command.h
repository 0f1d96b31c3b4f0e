// export: a scene's splats with their look baked, as Gaussians or a volume for other programs. Prints one
// line to stdout, everything else to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exit_code.h"
#include "progress_report.h"
#include "sets/set_cache.h"

namespace astrosplat {

struct ExportOptions {
    std::filesystem::path scene, output;
    std::optional<std::string> frame, layer, count, space, voxel_size;
    std::vector<std::string> assignments;
    SetCache cache;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};

/// The text of --help, with all that is approximated.
extern const char* const export_help;

/// Throws InputError, OutputError, Cancelled.
int run_export(const ExportOptions& options);

}  // namespace astrosplat
