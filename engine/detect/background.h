// The background of a picture, whatever stars stand on it: level and noise of values, of squares about a
// pixel, or in square cells as two small pictures of a pixel a cell (as SExtractor does; Bertin and Arnouts
// 1996, A&AS 117, 393).
#pragma once

#include "core/image.h"

namespace astrosplat {

/// The standard deviation of a Gaussian over the median of its values' distances from the middle.
inline constexpr double sigma_of_median_distance = 1.4826;

struct Background {
    float level = 0.0f;            // median
    float median_distance = 0.0f;  // of the values from it
    /// Standard deviation of a Gaussian that is as wide.
    float noise() const { return float(sigma_of_median_distance * double(median_distance)); }
};

/// Of values among which what stands out is rare; at least one. They are left in another order.
Background background_of(std::vector<float>& values);

/// Median over the square of `reach_px` about a pixel, as far as the image has it;
/// one channel of values >= 0.
float median_about(const Image& image, std::int64_t x, std::int64_t y);
inline constexpr std::int64_t median_reach_px = 5;

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
