#include "interrupt.h"

#include <csignal>

namespace astrosplat {
namespace {

std::atomic<bool> stop_asked{false};
std::atomic<int> signal_number{SIGINT};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "signal handlers may touch lock-free atomics only");

extern "C" void ask_to_stop(int number) {
    signal_number.store(number);
    stop_asked.store(true);
}

}  // namespace

void install_interrupt_handlers() {
    struct sigaction action = {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& interrupted() { return stop_asked; }

int interrupt_exit_code() { return 128 + signal_number.load(); }

}  // namespace astrosplat
