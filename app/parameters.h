// parameters: every key of a scene file, or of one scene with the values in use. Prints results to stdout,
// everything else to stderr, and returns the exit code.
#pragma once

#include <string>

#include "exit_code.h"

namespace astrosplat {

struct ParametersOptions {
    std::string scene;  // a file or a short name; empty: keys as the manual has them
    bool names = false, json = false;
};
int run_parameters(const ParametersOptions& options);

}  // namespace astrosplat
