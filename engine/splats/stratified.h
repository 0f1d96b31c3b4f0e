// The order in which a preview shows a set: any prefix is a fair sample of the whole in space. In: a
// SplatSet. Out: its rows by bit-reversed Morton rank (DESIGN 10), or a set made of the first of them.
#pragma once

#include <cstdint>

#include "core/buffer.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Rows of the set in stratified order: sorted along a Morton curve (21 bits an axis, ties by id), then by
/// the bit-reversed rank. The same for any thread count.
Buffer<std::int64_t> stratified_order(const SplatSet& set, const Progress& progress = {});

/// A set of the rows order[0 .. count), in that order (not by id), with all arrays the original has.
SplatSet take_rows(const SplatSet& set, const Buffer<std::int64_t>& order, std::int64_t count);

/// At most `count` rows, in an order of which any prefix is spread evenly over the set's own: in no time, and
/// for a first look as good as the stratified order, since that of a lattice runs through space too.
SplatSet sample_rows(const SplatSet& set, std::int64_t count);

/// The first rows of a set, with all arrays it has.
SplatSet first_rows(const SplatSet& set, std::int64_t count);

}  // namespace astrosplat
