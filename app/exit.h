// How the program ends: its exit codes; Ctrl-C and termination. Until something is written these end the
// process at once; from then on they are a flag that long work looks at, so that it stops between two pixels
// and leaves nothing half. And a limit on the size of files, which is to be an error of writing like
// a full disk.
#pragma once

#include <atomic>

#include "core/progress.h"

namespace astrosplat {

enum ExitCode : int {
    exit_done = 0,         // all asked frames exist
    exit_own_fault = 1,    // the program's own fault
    exit_not_started = 2,  // usage, bad input, would overwrite
    /// Some frames failed, and the last line names them; compare: too different; status: not all are there.
    exit_some_failed = 3,
    exit_not_writable = 4,  // the output cannot be written
};

/// SIGINT and SIGTERM end the process with one line and their exit code. SIGXFSZ is ignored.
void install_interrupt_handlers();

/// From now on the first SIGINT or SIGTERM sets interrupted(), and only the second one ends the process. To
/// be called before the first file is made, by what looks at the flag.
void defer_interrupts();

/// The last message of a stopped program.
inline constexpr const char* stopped_message = "stopped; nothing half-done was left behind";

/// For Progress::cancelled.
const std::atomic<bool>& interrupted();

/// Of work that reports nothing, but stops.
inline Progress stoppable() { return {{}, &interrupted()}; }

/// Of a program that was stopped: 130 after SIGINT, 143 after SIGTERM.
int interrupt_exit_code();

}  // namespace astrosplat
