// The commands as plain values: what a command line asks for, and the functions that do it. cli.cpp fills the
// values; each run_ function prints results to stdout, everything else to stderr, and returns the exit code.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "exit_code.h"
#include "generate/set_cache.h"

namespace astrosplat {

enum class ProgressMode { automatic, plain, none };

struct BatchOptions {
    std::filesystem::path scene;
    std::vector<std::string> assignments;   // --set KEY=VALUE
    std::optional<std::string> frames;      // replaces output.frames
    std::optional<std::string> output;      // replaces output.path; relative to the working directory
    std::optional<std::string> resolution;  // "1920x1080" or "50%"
    std::optional<std::string> layers;      // "A,B": only these
    std::optional<std::string> region;      // "X,Y,W,H" from the top left, px
    std::optional<std::string> memory_gib;  // limit of the renderer's working memory
    std::optional<std::filesystem::path> stats;
    SetCache cache;
    bool resume = false, overwrite = false, dry_run = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_batch(const BatchOptions& options);

struct NewOptions {
    std::filesystem::path image, scene;
    std::string shape = "plane";
    bool overwrite = false;
};
int run_new(const NewOptions& options);

struct GenerateOptions {
    std::filesystem::path scene, output;
    std::string layer;
    std::vector<std::string> assignments;
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

struct InfoOptions {
    std::filesystem::path file;
    bool json = false;
};
int run_info(const InfoOptions& options);

struct CompareOptions {
    std::filesystem::path a, b;
    bool json = false;
    std::optional<std::string> max_difference;  // exit_some_failed where a channel differs by more
};
int run_compare(const CompareOptions& options);

struct ParametersOptions {
    bool json = false;
};
int run_parameters(const ParametersOptions& options);

}  // namespace astrosplat
