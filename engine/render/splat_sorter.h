// Sorts a tile's splats into the total order of DESIGN 7. In: where they lie. Out: where each lies, near to
// far; the splats themselves are not moved.
#pragma once

#include <cstdint>
#include <span>

#include "core/buffer.h"
#include "core/progress.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// Keeps its memory from tile to tile.
class SplatSorter {
  public:
    /// Radix sort on depth, ties by in_front_of. The result lives until the next call.
    std::span<const ScreenSplat* const> sort(std::span<const std::span<const ScreenSplat>> runs,
                                             const Progress& progress, const TieIds& ids = {});
    /// Bytes that sort() takes for each record, besides the records.
    static constexpr std::int64_t bytes_per_record = 2 * sizeof(std::uint64_t) + 2 * sizeof(void*);

  private:
    int read(std::span<const std::span<const ScreenSplat>> runs, const Progress& progress);
    template <class Before>
    void put_in_order(int open_bits, const Before& before, const Progress& progress);

    Buffer<std::uint64_t> codes_, other_;  // depth less the least one above, place of arrival below
    Buffer<const ScreenSplat*> splats_, order_;
};

}  // namespace astrosplat
