// Blurs values on the cells of a chart by the footprints of the splats there. In and out: a float for each
// cell; nothing lies beyond a picture's edges, and pictures of different meshes do not mix.
#pragma once

#include <vector>

#include "core/buffer.h"
#include "look/picture_chart.h"

namespace astrosplat {

/// A float for each cell of a chart.
using CellValues = Buffer<float>;

class ChartBlur {
  public:
    /// A footprint's weights on the cells about its own, which sum to 1; `squared`: the squares of these.
    ChartBlur(const PictureChart& chart, bool squared);

    /// The same bits with any number of threads and on any instruction set.
    void operator()(CellValues& values);

  private:
    using Taps = std::vector<float>;  // an odd number, the middle one of the cell itself

    void along_rows(const CellValues& from, CellValues& to) const;
    void along_columns(const CellValues& from, CellValues& to) const;

    const PictureChart& chart_;
    std::vector<Taps> taps_u_, taps_v_;  // of each block
    std::int64_t reach_ = 0;             // cells, of the widest footprint
    CellValues between_;                 // rows are done, columns not yet
};

}  // namespace astrosplat
