// Pictures of one channel made from a picture's own light: maps of where dust absorbs it and where it is
// redder or bluer than the rest, and masks of where it is to show, told by brightness and colour, by an
// ellipse or by another picture. In: linear light. Out: shares of light, weights.
#pragma once

#include <span>

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

/// One channel of the picture's size, 0..1: the product over masks of the product of their terms and the
/// largest of their alternatives; `invert` makes 1 - w of a mask, or of an alternative. `light` is RGBA,
/// linear, premultiplied: colours are those seen over black. Edges are linear ramps of the width `feather`
/// about the border. Hue and saturation as in HSV, of display values; grey has no hue and is outside.
/// Throws InputError where an image cannot be read.
Image mask_weights(const Image& light, std::span<const MaskParams> masks);

}  // namespace astrosplat
