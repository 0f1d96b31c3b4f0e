// XXH64, the 64-bit hash of Yann Collet's xxHash, with seed 0: fast enough that checking a file costs less
// than copying it. It finds damage, not malice.
#pragma once

#include <xxhash.h>

#include <cstdint>
#include <string_view>

namespace astrosplat {

inline std::uint64_t xxh64(std::string_view bytes) { return XXH64(bytes.data(), bytes.size(), 0); }

}  // namespace astrosplat
