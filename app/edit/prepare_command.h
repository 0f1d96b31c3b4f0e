// The command line that prepares a layer's picture into a folder: what its keys do, said as options. In: a
// source. Out: words.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "source/source.h"

namespace astrosplat {

/// "prepare" and what follows it. Throws InputError where the source has no picture of its own.
std::vector<std::string> prepare_command(const SourceParams& source, const std::filesystem::path& folder);

}  // namespace astrosplat
