// Sorts a tile's splats into the total order of DESIGN 7. In: screen splats. Out: their indices, near to far.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// Keeps its memory from tile to tile.
class SplatSorter {
  public:
    /// Radix sort on depth, ties by in_front_of. The result lives until the next call.
    std::span<const std::uint32_t> sort(std::span<const ScreenSplat> splats, const Progress& progress);

  private:
    std::vector<std::uint64_t> keys_, other_;  // depth above, index below
    std::vector<std::uint32_t> order_;
};

}  // namespace astrosplat
