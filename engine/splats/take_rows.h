// Sets made of some of the rows of another. In: SplatSet. Out: SplatSet with all arrays it has.
#pragma once

#include <cstdint>

#include "core/buffer.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// A set of these rows, in their order.
SplatSet take_rows(const SplatSet& set, const Buffer<std::int64_t>& rows);

/// Of `size` rows cut into `count` even stretches, one of the i-th by chance: every n-th row of a lattice
/// would be a pattern. The same at every call.
std::int64_t sampled_row(std::int64_t size, std::int64_t count, std::int64_t i);

/// Those rows of all stretches, ascending; all rows where `count` is not less than `size`.
Buffer<std::int64_t> sampled_rows(std::int64_t size, std::int64_t count);

/// At most `count` rows, spread evenly over the set's own order.
SplatSet sample_rows(const SplatSet& set, std::int64_t count);

}  // namespace astrosplat
