// Camera files of every format for the fuzzer.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat::fuzz {

std::vector<std::string> camera_seeds();

/// By the reader that the bytes look most like: each format is told by its name's ending elsewhere.
std::size_t read_camera_bytes(std::string_view bytes);

}  // namespace astrosplat::fuzz
