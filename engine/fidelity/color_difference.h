// Differences of colour as an eye judges them: CIE L*a*b* and CIEDE2000. In: linear light, Rec. 709, on
// black. Out: differences, of which 1 is about the least that is seen side by side.
#pragma once

#include "core/image.h"

namespace astrosplat {

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

/// Over all pixels of two pictures of one size, or an even lattice of up to half a million of them.
ColorDifferences color_differences(const Image& a, const Image& b);

}  // namespace astrosplat
