// Options that several commands share. In: CLI11's command. Out: the same with one option more,
// whose value is written where it belongs.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>
#include <vector>

#include "invocation.h"

namespace astrosplat {

/// `value` is text or a path, maybe optional.
template <class Value>
CLI::Option* add_value(CLI::App& app, const std::string& names, Value& value, const std::string& placeholder,
                       const std::string& help) {
    const auto set = [&value](const std::string& text) { value = text; };
    return app.add_option_function<std::string>(names, set, help)->option_text(placeholder);
}

void add_assignments(CLI::App& app, std::vector<std::string>& values);  // --set
void add_progress(CLI::App& app, ProgressMode& mode);
/// Options that every command takes.
void add_common(CLI::App& app, CommonOptions& common);
/// The options that choose frames and their content.
void add_frame_choice(CLI::App& app, BatchOptions& batch);
/// A subcommand whose run is remembered, not done while parsing.
CLI::App& add_command(CLI::App& app, Invocation& call, const char* name, const char* help,
                      std::function<int()> action);

void add_commands(CLI::App& app, Invocation& call);

}  // namespace astrosplat
