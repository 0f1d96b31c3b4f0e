// generate and convert: splats into files, without rendering. Each prints results to stdout, everything else
// to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exit_code.h"
#include "progress_report.h"
#include "sets/set_cache.h"

namespace astrosplat {

struct GenerateOptions {
    std::filesystem::path scene, output;
    std::string layer;
    std::vector<std::string> assignments;
    std::optional<std::string> memory_gib;  // limit of what bodies are made in
    SetCache cache;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_generate(const GenerateOptions& options);

struct ConvertOptions {
    std::filesystem::path input, output;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_convert(const ConvertOptions& options);

}  // namespace astrosplat
