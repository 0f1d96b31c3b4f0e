// Places along a Morton curve: cells of a cube, ordered so that neighbours mostly lie together. In: whole
// coordinates. Out: one number with their bits interleaved.
#pragma once

#include <cstdint>

namespace astrosplat {

constexpr unsigned morton_axis_bits = 21;  // of each coordinate

/// Moves bit i of a 21-bit number to bit 3 i.
constexpr std::uint64_t spread_bits(std::uint64_t v) {
    v = (v | v << 32) & 0x001f00000000ffffu;
    v = (v | v << 16) & 0x001f0000ff0000ffu;
    v = (v | v << 8) & 0x100f00f00f00f00fu;
    v = (v | v << 4) & 0x10c30c30c30c30c3u;
    return (v | v << 2) & 0x1249249249249249u;
}

/// x varies fastest. Coordinates are below 2^21.
constexpr std::uint64_t morton_place(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

}  // namespace astrosplat
