// Gaussian blurs of images in memory. In and out: interleaved float channels; beyond its edges an image
// is mirrored (half-sample symmetric). The same bits with any number of threads.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// Convolves every channel with a Gaussian of standard deviation `sigma_px` >= 0: the kernel itself, cut at
/// 4 sigma and normalised. The cost grows with sigma.
Image convolved_with_gaussian(const Image& image, double sigma_px);

/// The same for any width at a cost that does not grow with it. Up to `widest_direct_px` it is the
/// convolution above; wider blurs are made at half the size (a binomial halving and a linear doubling add 1.5
/// px^2 of variance, which the blur between them leaves out), so that the profile stays within 1 % of the
/// Gaussian's peak; within a third with the least `widest_direct_px` there may be, 1.25. The image's sum
/// is kept where its sides are even as often as they are halved; elsewhere the last row and column weigh up
/// to a quarter less or more.
Image gaussian_blur(const Image& image, double sigma_px, double widest_direct_px = 4.0);

/// Half as wide and high (rounded up): each pixel a binomial average, weights 1 3 3 1 a side, about the
/// corner of four.
Image halved(const Image& image);

/// The inverse step: `width` x `height` px, interpolated linearly; `image` has half of each, rounded up.
Image doubled(const Image& image, std::int64_t width, std::int64_t height);

}  // namespace astrosplat
