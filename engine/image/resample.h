// Images at another size, as the renderer's pixels would show them. In: an image and where each output
// pixel lies in it. Out: the image convolved with the pixel filter and sampled at the output pixels.
#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "core/image.h"

namespace astrosplat {

/// Texel place = offset + linear * pixel place. Places are in px from the top left corner, so that the
/// centre of the first pixel is at (1/2, 1/2), on either side.
struct PixelMap {
    glm::dvec2 offset{0.0};
    glm::dmat2 linear{1.0};
};

/// The map under which the image fills an output of that size from left to right, its middle in the
/// middle.
PixelMap map_to_width(const Image& image, std::int64_t width, std::int64_t height);

/// The image convolved with a Gaussian of `sigma_px` output pixels (for a map that scales unevenly: of as
/// many texels as have the same area) and sampled, linearly between texels, at width x height pixel
/// centres. What lies outside of the image is 0.
Image resampled(const Image& image, const PixelMap& texel_from_pixel, std::int64_t width, std::int64_t height,
                double sigma_px);

}  // namespace astrosplat
