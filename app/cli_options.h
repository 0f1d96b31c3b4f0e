// Options of the program without a command. Together with the commands' they are the command line's words,
// said once: parsing, help, manual page and completion come from them.
#pragma once

#include "cli_parts.h"

namespace astrosplat {

/// Of window, --batch, --submit and --screenshot.
void add_program_options(CLI::App& app, Invocation& call);

}  // namespace astrosplat
