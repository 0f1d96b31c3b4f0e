// Maps that a picture's own light tells of: where dust absorbs it, where it is redder or bluer than the rest.
// In: linear light. Out: one channel, each value the share of light that the map stands for.
#pragma once

#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

/// One channel of the picture's size, 0..1, of `light` (RGB first, linear, premultiplied, >= 0); not for
/// none.
/// - dust: what an absorbing layer takes away, 1 - T. T = max(R, G, B) over that of a picture whose dark
///   details are filled: the sum of max(0, P_k - P_k+1) over bands P_k = mu_k clamp(1 - sd_k / (2 mean_k),
///   1/4, 1), P_0 = light, with blurs of 1.2, 2.4 ... px up to 80 px at a width of 1920. T is 0.1 at least.
/// - h_alpha: the share of red light beyond s (G + B) / 2, s the median of R over (G + B) / 2 where the
///   picture is lit: the continuum is taken off.
/// - young_stars: the share of blue light beyond s (R + G) / 2 in the same way.
/// Light of 0.002 of white counts as noise in all of them. The same bits with any number of threads.
Image derived_picture(const Image& light, Derived kind);

}  // namespace astrosplat
