// XXH64, the 64-bit hash of Yann Collet's xxHash (specification 0.1.1, seed 0), written from its description:
// fast enough that checking a file costs less than copying it. It finds damage, not malice.
#pragma once

#include <cstdint>
#include <string_view>

namespace astrosplat {

std::uint64_t xxh64(std::string_view bytes);

}  // namespace astrosplat
