// Dispatch only: runs the command line and turns exceptions into one line and an exit code.
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "cli.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "exit_code.h"
#include "interrupt.h"

using namespace astrosplat;

int main(int argc, char** argv) {
    install_interrupt_handlers();
    try {
        use_vector_target_of_environment();
        const int code = run_command_line(argc, argv);
        flush_warning_counts();
        return code;
    } catch (const InputError& error) {
        log_error(error.what());
        return exit_not_started;
    } catch (const OutputError& error) {
        log_error(error.what());
        return exit_not_writable;
    } catch (const Cancelled&) {
        log_error(stopped_message);
        return interrupt_exit_code();
    } catch (const std::bad_alloc&) {
        log_error("not enough memory");
        return exit_not_started;
    } catch (const std::system_error& error) {
        const bool busy = error.code() == std::errc::resource_unavailable_try_again;  // no thread to be had
        log_error((busy ? "the system gives no more threads: " : "internal error: ") +
                  std::string(error.what()));
        return busy ? exit_not_started : exit_own_fault;
    } catch (const std::exception& error) {
        log_error(std::string("internal error: ") + error.what());
        return exit_own_fault;
    }
}
