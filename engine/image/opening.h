// What is left of an image when everything that is small and bright is cut off (grey-scale opening). In: one
// channel. Out: another of the same size, nowhere larger.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// The largest, over all squares of 2 reach_px + 1 about the pixel's neighbours that hold it, of the least
/// value in the square: peaks narrower than a square are gone, slopes and edges stay. Squares that leave the
/// image count with what lies within. One channel, reach_px >= 0; the time hardly grows with reach_px.
Image opened(Image image, std::int64_t reach_px);

}  // namespace astrosplat
