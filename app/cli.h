// The command line: from argv to one of the commands of commands.h. The only place that knows CLI11.
#pragma once

namespace astrosplat {

/// Parses argv and runs what it asks for; returns the exit code. A usage mistake is one line on stderr and
/// code 2. Throws what the commands throw.
int run_command_line(int argc, char** argv);

}  // namespace astrosplat
