// Images made smaller by any ratio, and larger by whole numbers. In: an image in memory. Out: one whose
// pixels are the means of what they cover, or which share out what theirs was.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// The image on width x height pixels, no more than it has. Its mean is kept.
Image reduced_by_area(const Image& image, std::int64_t width, std::int64_t height);

/// Each pixel becomes times x times. They rise and fall towards its neighbours, and their mean is what the
/// pixel was: no light moves from one pixel into another, and nothing overshoots below 0. A value that is not
/// finite, or is less than 0, counts as 0.
Image enlarged(const Image& image, int times);

}  // namespace astrosplat
