// fidelity: how true a scene is to its picture, as a page or as JSON. Prints results to stdout, everything
// else to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exit_code.h"
#include "progress_report.h"
#include "sets/set_cache.h"

namespace astrosplat {

struct FidelityOptions {
    std::filesystem::path scene, output;
    std::optional<std::filesystem::path> reference;  // in place of the layer's own picture
    std::vector<std::string> assignments;            // --set KEY=VALUE
    SetCache cache;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_fidelity(const FidelityOptions& options);

}  // namespace astrosplat
