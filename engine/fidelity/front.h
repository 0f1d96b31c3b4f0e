// All measures of a front view against the picture it is made of. In: both as linear light at one size.
// Out: numbers.
#pragma once

#include <vector>

#include "fidelity/color_difference.h"
#include "fidelity/flux.h"
#include "fidelity/scale_power.h"

namespace astrosplat {

struct FrontFidelity {
    std::int64_t width_px = 0, height_px = 0;  // of the whole view
    double psnr_db = 0.0, ssim = 0.0;
    FluxRatios flux;
    ColorDifferences ciede2000;
    std::vector<ScalePower> power;
};

/// `border`: share of the width that is left out along every edge, 0 to below 1/2.
FrontFidelity front_fidelity(const Image& rendered, const Image& reference, double border = 0.0);

/// Bytes that it takes at its peak, about, beside the two pictures.
std::int64_t front_fidelity_bytes(std::int64_t width_px, std::int64_t height_px);

}  // namespace astrosplat
