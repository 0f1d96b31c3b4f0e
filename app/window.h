// The program without --batch and without a command: the window, or a screenshot of it. A build
// without the window says so.
#pragma once

#include "invocation.h"

namespace astrosplat {

/// The exit code. Throws InputError, OutputError, Cancelled.
int run_window(Invocation& call);

}  // namespace astrosplat
