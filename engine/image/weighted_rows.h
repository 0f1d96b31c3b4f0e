// The inner loop of blurs. Compiled once per instruction set with the same bits on each.
#pragma once

#include <cstdint>
#include <span>

namespace astrosplat {

/// out[i] = sum of weights[k] * rows[k][i] for i in [0, count), terms in ascending k. `out` overlaps no row.
void weighted_rows(std::span<const float> weights, std::span<const float* const> rows, std::int64_t count,
                   float* out);

}  // namespace astrosplat
