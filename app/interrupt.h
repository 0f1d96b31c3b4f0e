// Ctrl-C and termination: a flag that long work looks at, so that it stops between two pixels and leaves
// nothing half. And a limit on the size of files, which is to be an error of writing like a full disk.
#pragma once

#include <atomic>

namespace astrosplat {

/// SIGINT and SIGTERM set interrupted() from now on; the second one ends the process at once. SIGXFSZ is
/// ignored.
void install_interrupt_handlers();

/// For Progress::cancelled.
const std::atomic<bool>& interrupted();

/// 130 after SIGINT, 143 after SIGTERM.
int interrupt_exit_code();

}  // namespace astrosplat
