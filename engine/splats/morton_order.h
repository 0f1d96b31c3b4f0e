// The rows of a set along a Morton curve, so that neighbours mostly lie together. In: SplatSet. Out: its rows
// with their codes, in ascending order of code.
#pragma once

#include <cstdint>

#include "core/buffer.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// The highest bit of a code, below which are 21 bits an axis (core/morton.h): the splat absorbs.
constexpr std::uint64_t morton_absorbs = std::uint64_t{1} << 63;

struct MortonRow {
    std::uint64_t code;
    std::int64_t row;
};

/// Cells are cubes, the longest side of the set's box 2^21 of them; on a lattice (SplatSetFacts) the
/// first boundary across each side is in the middle of the box. Rows of equal code in order of id. The
/// same for any thread count. Throws Cancelled.
Buffer<MortonRow> morton_order(const SplatSet& set, const Progress& progress = {});

}  // namespace astrosplat
