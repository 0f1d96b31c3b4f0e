// Whether a picture is as rich in detail of every size as another: the power of octave bands. In: linear
// light. Out: ratios.
#pragma once

#include <vector>

#include "core/image.h"

namespace astrosplat {

/// Detail between two sizes: the difference of the picture's Gaussian blurs of standard deviations finer
/// and coarser.
struct ScalePower {
    double finer_px = 0.0, coarser_px = 0.0;  // 0: the picture itself
    double ratio = 0.0;  // mean square of the picture's band over that of the reference's
};

/// Bands 0 to 1, 1 to 2, 2 to 4 ... px up to an eighth of the shorter side, of the displayed channels'
/// mean. NaN where the reference has no detail of a size.
std::vector<ScalePower> power_by_scale(const Image& picture, const Image& reference);

}  // namespace astrosplat
