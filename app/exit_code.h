// The program's exit codes, for scripts.
#pragma once

namespace astrosplat {

enum ExitCode : int {
    exit_done = 0,         // all asked frames exist
    exit_own_fault = 1,    // the program's own fault
    exit_not_started = 2,  // usage, bad input, would overwrite
    exit_some_failed =
        3,  // some frames failed: the last line names them; compare: too different; status: not all are there
    exit_not_writable = 4,   // the output cannot be written
    exit_interrupted = 130,  // SIGINT
    exit_terminated = 143,   // SIGTERM
};

}  // namespace astrosplat
