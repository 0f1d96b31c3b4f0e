// parameters: every key of a scene file. Prints results to stdout, everything else to stderr, and returns the
// exit code.
#pragma once

#include "exit_code.h"

namespace astrosplat {

struct ParametersOptions {
    bool json = false;
};
int run_parameters(const ParametersOptions& options);

}  // namespace astrosplat
