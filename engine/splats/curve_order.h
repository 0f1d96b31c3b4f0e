// Order along a Hilbert curve, so that what lies together in space lies together in memory. In: places in a
// cube. Out: their numbers on the curve, and an order sorted by them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "core/buffer.h"

namespace astrosplat {

/// Place along a Hilbert curve through a cube of side 2 * reach around the origin, by J. Skilling's method
/// (Programming the Hilbert curve, 2004), 10 bits an axis; places outside count as on the cube's side.
std::uint32_t curve_place(const glm::dvec3& p, double reach);

/// Sorts by the upper 32 bits, of which 30 are in use, and leaves equal ones in their order.
void sort_by_place(Buffer<std::uint64_t>& order);

}  // namespace astrosplat
