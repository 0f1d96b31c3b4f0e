// Stars too bright for the picture. In: linear light and the value at which it saturates. Out: stars fitted
// to what can be seen of them, their wings.
#pragma once

#include <vector>

#include "prepare/star_fit.h"

namespace astrosplat {

/// The pixels where a channel reaches `level`.
PixelMask saturated_pixels(const Image& image, double level);

/// Round saturated patches from which the light falls off steeply all around; `noise` is that of a height,
/// for all of them. Patches of less than 9 pixels are left to the ordinary search. Subtracts the stars'
/// profiles from the picture.
std::vector<PictureStar> take_saturated_stars(Image& image, const PixelMask& saturated, double noise);

/// The pixels of a star that its profile does not describe: its core and diffraction spikes, found in the
/// picture less the star as rays that stand out of the ring they cross.
void mark_core_and_spikes(const Image& without, const PictureStar& star, PixelMask& mask);

}  // namespace astrosplat
