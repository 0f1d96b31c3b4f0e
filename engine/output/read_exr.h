// EXR frames read back, by OpenEXR.
#pragma once

#include <filesystem>
#include <optional>

#include "output/stored_header.h"

namespace astrosplat {

std::optional<StoredHeader> read_exr_header(const std::filesystem::path& file);
/// True when the file was read to its last pixel. False says nothing of files with tiles or several parts.
bool exr_is_whole(const std::filesystem::path& file);

}  // namespace astrosplat
