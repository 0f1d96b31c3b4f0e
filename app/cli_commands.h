// The program's commands with their options.
#pragma once

#include "cli_parts.h"

namespace astrosplat {

void add_commands(CLI::App& app, Invocation& call);

}  // namespace astrosplat
