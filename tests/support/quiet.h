// The log in tests: silenced where sets are loaded on the way to something else, or caught to be compared.
#pragma once

#include "core/log.h"

namespace astrosplat {

/// While it lives, only warnings and errors are printed.
struct Quiet {
    Quiet() { set_log_level(LogLevel::warning); }
    ~Quiet() { set_log_level(LogLevel::info); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
};

/// While it lives, nothing is printed: what is said comes here, line by line, and warnings once more apart.
struct Said {
    std::vector<std::string> lines, warnings;

    Said() {
        forget_warnings();
        set_log_sink([this](LogLevel level, const std::string& line) {
            lines.push_back(line);
            if (level == LogLevel::warning) warnings.push_back(line);
        });
    }
    ~Said() {
        forget_warnings();
        set_log_sink(nullptr);
    }
    Said(const Said&) = delete;
    Said& operator=(const Said&) = delete;

    /// The only warning, or how many there are.
    std::string one_warning() const {
        return warnings.size() == 1 ? warnings[0] : std::to_string(warnings.size()) + " warnings";
    }
    std::string text() const {
        std::string all;
        for (const std::string& line : lines) all += line + "\n";
        return all;
    }
};

/// What a call warns of.
template <class Call>
std::vector<std::string> warnings_of(const Call& call) {
    const Said said;
    call();
    return said.warnings;
}

}  // namespace astrosplat
