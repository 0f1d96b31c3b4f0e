// Messages to the person at the terminal (stderr) or, later, to the viewer's message bar. Results go to
// stdout elsewhere; nothing here reaches a pixel or a file.
#pragma once

#include "core/standard.h"

namespace astrosplat {

enum class LogLevel { error, warning, info, detail };

/// Messages above this level are dropped; `-q` sets warning, `-v` sets detail. Default: info.
void set_log_level(LogLevel level);

/// Replaces the place messages go to (default: stderr, prefixed "astrosplat: "). Pass nullptr to restore it.
/// The sink is called by one thread at a time and must not log itself.
void set_log_sink(std::function<void(LogLevel, const std::string&)> sink);

/// `format` makes the line on stderr of a message; nullptr: "astrosplat: warning: LINE". Set before
/// other threads run.
void set_log_format(std::string (*format)(LogLevel, const std::string&));

/// "astrosplat: warning: LINE", or as set_log_format() says: what a terminal shows of a message.
std::string terminal_line(LogLevel level, const std::string& line);

/// One line, without a newline; what is not printable (of a file's name) is escaped. Thread-safe.
void log_line(LogLevel level, const std::string& line);
void log_error(const std::string& line);
void log_info(const std::string& line);
void log_detail(const std::string& line);

/// Odd but usable input. The same line is said once, however often a file is opened; `forget_warnings` starts
/// afresh.
void log_warning(const std::string& line);
void forget_warnings();

/// While it lives, nothing that this thread says is heard or remembered: it looks at files that were not
/// asked for yet.
class QuietLog {
  public:
    QuietLog();
    ~QuietLog();
    QuietLog(const QuietLog&) = delete;
    QuietLog& operator=(const QuietLog&) = delete;
};

}  // namespace astrosplat
