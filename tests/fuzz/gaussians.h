// The fuzzed readers of captures: seeds, and checks of what was read.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat::fuzz {

/// PLY files of Gaussians; glTF files of them, binary and as text; USD.
std::vector<std::string> gaussian_ply_seeds();
std::vector<std::string> gltf_seeds();
std::vector<std::string> usda_seeds();

/// Reads the bytes as a file; throws InputError for bad input.
std::size_t read_gaussian_ply_bytes(std::string_view bytes);
std::size_t read_gltf_bytes(std::string_view bytes);
std::size_t read_usda_bytes(std::string_view bytes);

}  // namespace astrosplat::fuzz
