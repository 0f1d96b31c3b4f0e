// How alike two pictures of one size look. In: linear light (display.h says how it is seen). Out: numbers.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// Peak signal to noise ratio of the displayed channels, dB: 10 log10(1 / mean square error), at most 120.
double psnr_db(const Image& a, const Image& b);

/// Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) of the displayed channels' mean: Gaussian
/// window of 1.5 px, constants .01^2 and .03^2, mean over all pixels; 1 for equal pictures.
double ssim(const Image& a, const Image& b);

}  // namespace astrosplat
