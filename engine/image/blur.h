// Images less their detail: Gaussian blurs, and grey-scale openings, which cut off what is small and bright.
// In and out: interleaved float channels; the same bits with any number of threads and on every instruction
// set. For a blur an image is mirrored beyond its edges (half-sample symmetric).
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

/// The same of an image that is not wanted any more: a wide blur gives its memory back before it takes its
/// own.
Image gaussian_blur(Image&& image, double sigma_px, double widest_direct_px = 4.0);

/// Half as wide and high (rounded up): each pixel a binomial average, weights 1 3 3 1 a side, about the
/// corner of four.
Image halved(const Image& image);

/// The inverse step: `width` x `height` px, interpolated linearly; `image` has half of each, rounded up.
Image doubled(const Image& image, std::int64_t width, std::int64_t height);

/// The largest, over all squares of 2 reach_px + 1 about the pixel's neighbours that hold it, of the least
/// value in the square: peaks narrower than a square are gone, slopes and edges stay. Squares that leave the
/// image count with what lies within. One channel, reach_px >= 0; the time hardly grows with reach_px.
Image opened(Image image, std::int64_t reach_px);

/// The inner loop of blurs: out[i] = sum of weights[k] * rows[k][i] for i in [0, count), terms in ascending
/// k. `out` overlaps no row.
void weighted_rows(std::span<const float> weights, std::span<const float* const> rows, std::int64_t count,
                   float* out);

}  // namespace astrosplat
