// Whether a picture holds as much light as another, in all and place by place. In: linear light, on black.
// Out: ratios.
#pragma once

#include <array>
#include <vector>

#include "core/image.h"

namespace astrosplat {

/// Cells along either side of the grid that a picture is divided into.
inline constexpr std::int64_t flux_cells = 32;
/// A cell of the reference darker than this, as the mean of its channels (1: white), holds no light to
/// compare with.
inline constexpr double darkest_cell = 0.002;

struct FluxRatios {
    std::array<double, 3> channels{};  // light of the picture over light of the reference: red, green, blue
    double frame = 0.0;                // of all three
    std::vector<double> cells;         // flux_cells^2 from the top left; NaN where the reference is dark
    double cells_5 = 0.0, cells_50 = 0.0,
           cells_95 = 0.0;  // percentiles of the lit cells; 0 where none is lit
};

/// NaN where the reference has no light.
FluxRatios flux_ratios(const Image& picture, const Image& reference);

}  // namespace astrosplat
