// Numbers for tests, the same on every machine.
#pragma once

#include <cstdint>

namespace astrosplat::test {

/// In [0, 1), by a mix of two words (Wellons' lowbias32).
inline double hash_unit(std::uint32_t seed, std::uint32_t purpose) {
    std::uint32_t x = seed * 0x9E3779B9u + purpose * 0x85EBCA6Bu + 1u;
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    x ^= x >> 16;
    return static_cast<double>(x) / 4294967296.0;
}

}  // namespace astrosplat::test
