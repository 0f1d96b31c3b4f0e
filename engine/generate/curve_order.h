// Order along a Hilbert curve, so that what lies together in space lies together in memory. In: places in a
// cube. Out: their numbers on the curve, and an order sorted by them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "core/buffer.h"

namespace astrosplat {

/// Places along a Hilbert curve through a cube of side 2 * reach around the origin, by J. Skilling's method
/// (Programming the Hilbert curve, 2004), 10 bits an axis; points outside count as on the cube's side.
class CurvePlaces {
  public:
    static constexpr std::size_t most = 64;
    using Numbers = std::array<std::uint32_t, most>;

    /// At most `most` points.
    void add(const glm::dvec3& p, double reach);
    /// Their places, in the order of add(), and empty again. Good until the next add().
    const Numbers& finish();

  private:
    std::size_t count_ = 0;
    Numbers x_{}, y_{}, z_{};  // cells
};

/// Sorts by the upper 32 bits, of which 30 are in use, and leaves equal ones in their order.
void sort_by_place(Buffer<std::uint64_t>& order);

}  // namespace astrosplat
