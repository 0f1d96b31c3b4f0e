// compare: how far two images are apart. Prints results to stdout, everything else to stderr, and returns
// the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "exit_code.h"

namespace astrosplat {

struct CompareOptions {
    std::filesystem::path a, b;
    bool json = false;
    std::optional<std::string> max_difference;  // exit_some_failed where a channel differs by more
};
int run_compare(const CompareOptions& options);

}  // namespace astrosplat
