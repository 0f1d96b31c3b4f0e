// The order in which a native file stores its splats: coarse cells along a Morton curve, so that a block of
// neighbouring rows is a small region of space. In: SplatSet. Out: the row indices in that order.
#pragma once

#include <cstdint>

#include "core/buffer.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Cubic cells, 64 along the longest side of the set's box, in Morton order (x lowest); inside a cell
/// ascending ids, equal ids in the set's order. The same for any thread count. Row: std::uint32_t, for sets
/// of fewer than 2^32 splats, or std::uint64_t.
template <class Row>
Buffer<Row> spatial_order(const SplatSet& set);

}  // namespace astrosplat
