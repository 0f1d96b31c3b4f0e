// The options of `prepare` that are also keys of a source: from their one description. In: words as typed.
// Out: settings, checked.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "source/source.h"

namespace astrosplat {

/// The command's defaults: it takes the stars away, and shows three filters with one
/// asinh.
TextureSettings default_prepare_settings(bool three_filters);

/// For --help.
struct PrepareOption {
    std::string key, option, placeholder, help;
};
std::vector<PrepareOption> prepare_options();

/// Whether three filters are given. Throws InputError unless that is so or one picture is given.
bool has_three_filters(const PrepareOptions& options);

/// Throws InputError for what cannot be or would do nothing.
TextureSettings prepare_settings(const PrepareOptions& options);

}  // namespace astrosplat
