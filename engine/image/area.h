// Images made smaller by any ratio. In: an image in memory. Out: each pixel the mean of what it covers.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// The image on width x height pixels, no more than it has. Its mean is kept.
Image reduced_by_area(const Image& image, std::int64_t width, std::int64_t height);

}  // namespace astrosplat
