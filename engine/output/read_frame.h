// What a frame file that lies there already tells of itself.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

namespace astrosplat {

/// frame_hash and pixel_hash stored in a frame file, empty when there are none or the file is damaged.
std::pair<std::string, std::string> read_frame_hashes(const std::filesystem::path& file);

/// True when the file can be read to its last pixel.
bool frame_is_whole(const std::filesystem::path& file);

}  // namespace astrosplat
