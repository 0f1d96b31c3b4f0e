// Star catalogues for the fuzzer: seeds of every format and what is demanded of the result.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat::fuzz {

/// Hipparcos, HYG, a table with names, gzip-compressed.
std::vector<std::string> catalogue_seeds();

/// Reads a catalogue and makes a set of it. Throws InputError; std::logic_error for results that cannot be.
std::size_t read_catalogue_bytes(std::string_view bytes);

}  // namespace astrosplat::fuzz
