// Whole files as text.
#pragma once

#include <filesystem>
#include <string>

namespace astrosplat {

/// All bytes of a regular file. Throws InputError (missing, a folder, unreadable, larger than the memory
/// left).
std::string read_file(const std::filesystem::path& file);

}  // namespace astrosplat
