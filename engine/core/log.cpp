// Messages: a level, a sink and the warnings said so far, behind one mutex.
#include "core/log.h"

#include <fmt/format.h>

#include <cstdio>
#include <mutex>
#include <set>

#include "core/text.h"

namespace astrosplat {
namespace {

struct Log {
    std::mutex mutex;
    LogLevel level = LogLevel::info;
    std::function<void(LogLevel, const std::string&)> sink;
    std::string (*format)(LogLevel, const std::string&) = nullptr;
    std::set<std::string> warnings;  // what was said
};

thread_local int quiet_depth = 0;

Log& the_log() {
    static Log log;
    return log;
}

// Called with the mutex held, so that lines of several threads never mix.
void emit(Log& log, LogLevel level, const std::string& line) {
    if (level > log.level || quiet_depth > 0) return;
    if (log.sink)
        log.sink(level, printable(line));
    else
        fmt::print(stderr, "{}\n", terminal_line(level, printable(line)));
}

}  // namespace

std::string terminal_line(LogLevel level, const std::string& line) {
    if (const auto format = the_log().format) return format(level, line);
    const char* kind = level == LogLevel::warning ? "warning: " : level == LogLevel::error ? "error: " : "";
    return fmt::format("astrosplat: {}{}", kind, line);
}

void set_log_format(std::string (*format)(LogLevel, const std::string&)) { the_log().format = format; }

void set_log_level(LogLevel level) {
    Log& log = the_log();
    const std::lock_guard lock(log.mutex);
    log.level = level;
}

void set_log_sink(std::function<void(LogLevel, const std::string&)> sink) {
    Log& log = the_log();
    const std::lock_guard lock(log.mutex);
    log.sink = std::move(sink);
}

void log_line(LogLevel level, const std::string& line) {
    Log& log = the_log();
    const std::lock_guard lock(log.mutex);
    emit(log, level, line);
}

void log_error(const std::string& line) { log_line(LogLevel::error, line); }
void log_info(const std::string& line) { log_line(LogLevel::info, line); }
void log_detail(const std::string& line) { log_line(LogLevel::detail, line); }

void log_warning(const std::string& line) {
    if (quiet_depth > 0) return;
    Log& log = the_log();
    const std::lock_guard lock(log.mutex);
    if (log.warnings.insert(line).second) emit(log, LogLevel::warning, line);
}

void forget_warnings() {
    Log& log = the_log();
    const std::lock_guard lock(log.mutex);
    log.warnings.clear();
}

QuietLog::QuietLog() { ++quiet_depth; }
QuietLog::~QuietLog() { --quiet_depth; }

}  // namespace astrosplat
