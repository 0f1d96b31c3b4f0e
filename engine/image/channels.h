// Single channels of pictures. In: a picture in memory. Out: one channel of it, or a value between its
// pixels.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// max(R, G, B) of every pixel.
Image brightest_channel(const Image& light);

/// Value of a channel at (x, y) px from the top left corner, linear between pixel centres, clamped at the
/// edges.
float bilinear(const Image& image, int channel, float x, float y);

}  // namespace astrosplat
