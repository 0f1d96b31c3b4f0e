// Which splats of a set that was made of a picture are stars, which are dust. Ids of such sets hold the
// number of their band in bits 48 to 55, above the place within it; ids of lattices and rows of files do not
// reach that far.
#pragma once

#include <cstdint>

namespace astrosplat {

inline constexpr std::uint64_t star_band = 255, dust_band = 254;

constexpr bool is_star(std::uint64_t id) { return (id >> 48 & 255) == star_band; }

}  // namespace astrosplat
