// Tests that load sets on their way to something else do not repeat what the loader says.
#pragma once

#include "core/log.h"

namespace astrosplat {

/// While it lives, only warnings and errors are printed.
struct Quiet {
    Quiet() { set_log_level(LogLevel::warning); }
    ~Quiet() { set_log_level(LogLevel::info); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
};

}  // namespace astrosplat
