// What a picture's background is, in square cells: its level and its noise, whatever stars stand on it. In: a
// picture. Out: two small pictures of a pixel a cell (as SExtractor does; Bertin and Arnouts 1996, A&AS 117,
// 393).
#pragma once

#include "core/image.h"

namespace astrosplat {

struct Cells {
    std::int64_t cell_px = 0;  // side; cells at the right and lower edge may be smaller
    Image level;               // median of each channel
    Image noise;               // standard deviation about it, of a Gaussian with the same quartiles
};

/// Median and noise without what is farther than three times the noise from the median, and then of the nine
/// cells around each the median. The same bits with any number of threads.
Cells measure_cells(const Image& image, std::int64_t cell_px);

/// Linear between the cells' middles, and level beyond the outermost; (x, y) in px from the picture's top
/// left corner.
double interpolated(const Image& cells, std::int64_t cell_px, double x, double y, int channel);

}  // namespace astrosplat
