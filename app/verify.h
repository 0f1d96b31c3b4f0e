// verify: renders frames again and says whether their files hold what the scene gives. Prints results to
// stdout, everything else to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "batch.h"

namespace astrosplat {

struct VerifyOptions {
    BatchOptions batch;  // scene, assignments, layers, memory, cache and progress are used
    std::vector<std::filesystem::path> files;  // frames in any order, each of any size, region and eye
    bool json = false;
};
/// exit_done when all are equal, else exit_some_failed.
int run_verify(const VerifyOptions& options);

}  // namespace astrosplat
