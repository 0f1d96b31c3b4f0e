// The text of a star catalogue. In: a file, gzip-compressed or not, whatever its name. Out: its bytes.
#pragma once

#include <filesystem>
#include <string>

#include "core/progress.h"

namespace astrosplat {

/// Throws InputError for files that cannot be read, damaged gzip data and text larger than the memory left;
/// Cancelled.
std::string read_catalogue_text(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace astrosplat
