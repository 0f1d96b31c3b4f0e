// Images as they are seen, for measures that judge what is seen: sRGB values, CIE L*a*b* and the difference
// of colours as an eye judges it (CIEDE2000, of which 1 is about the least that is seen side by side). In:
// linear light of at least three channels, Rec. 709, on black (premultiplied). Out: images of sRGB values
// in [0, 1], one of them for eyes: where an image is brighter or darker than another; differences.
#pragma once

#include "core/image.h"
#include "core/parallel.h"

namespace astrosplat {

/// Red, green and blue as displayed.
Image display_colors(const Image& linear);

/// One channel: the mean of the three displayed ones.
Image display_mean(const Image& linear);

/// One channel: the largest of the three displayed ones.
Image display_max(const Image& linear);

/// The three channels of linear light inside a margin of `margin_px` on every side (at most up
/// to the middle).
Image inner_colors(const Image& linear, std::int64_t margin_px);

/// Difference of displayed values that is shown in full colour, of white.
inline constexpr double full_difference = 0.1;

/// Displayed value a minus b, mean of the channels, as RGBA with alpha 1: orange where a is brighter, blue
/// where it is darker, nearly black where they are equal.
Image signed_difference(const Image& a, const Image& b);

/// The sum of row(y) for y in [0, height): rows on all threads, their sums in order.
template <class Row>
double sum_over_rows(std::int64_t height, const Row& row) {
    std::vector<double> sums(height);
    parallel_each(height, 16, [&](std::int64_t y) { sums[y] = row(y); });
    double sum = 0.0;
    for (const double s : sums) sum += s;
    return sum;
}

struct Lab {
    double L = 0.0, a = 0.0, b = 0.0;  // CIE 1976, white D65
};

/// Of three channels, each clamped to [0, 1]; (1, 1, 1) is L = 100, a = b = 0.
Lab lab_of_linear(const float* rgb);

/// CIEDE2000 with k_L = k_C = k_H = 1, as G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 Color-Difference
/// Formula: Implementation Notes, Supplementary Test Data, and Mathematical Observations", Color Res. Appl.
/// 30 (2005), write it.
double ciede2000(const Lab& first, const Lab& second);

struct ColorDifferences {
    double median = 0.0, percentile_95 = 0.0;
};

/// Over all pixels of two images of one size, or an even lattice of up to half a million of them.
ColorDifferences color_differences(const Image& a, const Image& b);

}  // namespace astrosplat
