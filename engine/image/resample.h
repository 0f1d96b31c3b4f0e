// Images at another size: smaller by any ratio or larger by whole numbers, in pixels that are the means of
// what they cover; or as the renderer's pixels would show them. In: an image in memory, or by rows.
// Out: another.
#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "core/image.h"

namespace astrosplat {

/// An image that is handed out by rows, from the first one on: `read` writes those from `begin` to `end`, of
/// width * channels values each. Whoever takes them asks for each row once, in their order.
struct ImageRows {
    std::int64_t width = 0, height = 0;  // px
    int channels = 0;
    std::function<void(std::int64_t begin, std::int64_t end, float* rows)> read;
};

/// Those of an image, which they hold.
ImageRows rows_of(Image image);

/// All of them, taken a strip at a time.
Image read_whole(const ImageRows& rows);

/// How many rows are taken at once: some 32 MiB of them.
std::int64_t strip_rows(const ImageRows& rows);

struct ImageSize {
    std::int64_t width = 0, height = 0;  // px
};

/// That of an image reduced to `area` px^2, but to no less than `smallest_px` a side, if it had as many.
ImageSize size_of_area(std::int64_t width, std::int64_t height, double area, double smallest_px);

/// The image on width x height pixels, no more than it has. Its mean is kept. Of rows, a strip is held at a
/// time; the bits are the same.
Image reduced_by_area(const Image& image, std::int64_t width, std::int64_t height);
Image reduced_by_area(const ImageRows& rows, std::int64_t width, std::int64_t height);
/// The image no wider than that, in its proportions.
Image reduced_to_width(const Image& image, std::int64_t most_px);

/// Each pixel becomes times x times. They rise and fall towards its neighbours, and their mean is what the
/// pixel was: no light moves from one pixel into another, and nothing overshoots below 0. A value that is not
/// finite, or is less than 0, counts as 0.
Image enlarged(const Image& image, int times);

/// Texel place = offset + linear * pixel place. Places are in px from the top left corner, so that the
/// centre of the first pixel is at (1/2, 1/2), on either side.
struct PixelMap {
    glm::dvec2 offset{0.0};
    glm::dmat2 linear{1.0};
};

/// The map under which the image fills an output of that size from left to right,
/// its middle in the middle.
PixelMap map_to_width(const Image& image, std::int64_t width, std::int64_t height);

/// The image convolved with a Gaussian of `sigma_px` output pixels (for a map that scales unevenly: of as
/// many texels as have the same area) and sampled, linearly between texels, at width x height pixel
/// centres. What lies outside of the image is 0.
Image resampled(const Image& image, const PixelMap& texel_from_pixel, std::int64_t width, std::int64_t height,
                double sigma_px);

}  // namespace astrosplat
