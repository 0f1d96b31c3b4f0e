// Pictures as they are seen, for measures that judge what is seen. In: linear light of at least three
// channels, on black (premultiplied). Out: pictures of sRGB values in [0, 1].
#pragma once

#include "core/image.h"

namespace astrosplat {

/// Red, green and blue as displayed.
Image display_colors(const Image& linear);

/// One channel: the mean of the three displayed ones.
Image display_mean(const Image& linear);

/// One channel: the largest of the three displayed ones.
Image display_max(const Image& linear);

/// The three channels of linear light inside a margin of `margin_px` on every side (at most up to the
/// middle).
Image inner_colors(const Image& linear, std::int64_t margin_px);

}  // namespace astrosplat
