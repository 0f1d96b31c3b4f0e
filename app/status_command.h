// status: which frames of a scene are there and right, which are missing, damaged or of other settings.
// Renders nothing and touches nothing. Prints results to stdout, everything else to stderr, and returns the
// exit code.
#pragma once

#include "batch.h"

namespace astrosplat {

struct StatusOptions {
    BatchOptions batch;  // what --batch would be given: the same frames are expected
    bool json = false;
};

/// exit_done where every frame is there, exit_some_failed otherwise. Throws InputError.
int run_status(const StatusOptions& options);

}  // namespace astrosplat
