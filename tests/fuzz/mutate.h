// Deterministic damage to a file: mutation k of some bytes is the same everywhere and for ever.
#pragma once

#include <cstdint>
#include <string>

namespace astrosplat::fuzz {

/// One to four edits: flipped bits, replaced bytes, cut ends, removed, repeated or exchanged pieces, words
/// replaced by awkward ones ("1e999", "-1", "nan", ...).
std::string mutate(std::string bytes, std::uint32_t number);

}  // namespace astrosplat::fuzz
