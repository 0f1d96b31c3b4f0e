// info: what any file the program reads holds. Prints results to stdout, everything else to stderr, and
// returns the exit code.
#pragma once

#include <filesystem>

#include "exit_code.h"

namespace astrosplat {

struct InfoOptions {
    std::filesystem::path file;
    bool json = false;
};
int run_info(const InfoOptions& options);

}  // namespace astrosplat
