#include "exit.h"

#include <unistd.h>

#include <csignal>

#include "core/log.h"

namespace astrosplat {
namespace {

std::atomic<bool> stop_asked{false}, deferred{false};
std::atomic<int> signal_number{SIGINT};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "signal handlers may touch lock-free atomics only");

// Made before any signal: a handler may not allocate.
const std::string& last_line() {
    static const std::string line = terminal_line(LogLevel::error, stopped_message) + "\n";
    return line;
}

extern "C" void ask_to_stop(int number) {
    signal_number.store(number);
    if (!deferred.load()) {
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, last_line().data(), last_line().size());
        _exit(interrupt_exit_code());
    }
    stop_asked.store(true);
}

}  // namespace

void install_interrupt_handlers() {
    last_line();
    struct sigaction action = {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}

void defer_interrupts() { deferred.store(true); }

const std::atomic<bool>& interrupted() { return stop_asked; }

int interrupt_exit_code() { return 128 + signal_number.load(); }

}  // namespace astrosplat
