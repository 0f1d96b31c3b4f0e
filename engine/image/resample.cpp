#include "image/resample.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "core/parallel.h"
#include "image/blur.h"

namespace astrosplat {
namespace {

// Two neighbouring texels along an axis of n and the share of the second.
struct Neighbours {
    std::int64_t first, second;
    float share;
};

Neighbours neighbours(double place, std::int64_t n) {
    const double at = std::clamp(place - 0.5, 0.0, static_cast<double>(n - 1));
    const double below = std::floor(at);
    const auto first = static_cast<std::int64_t>(below);
    return {first, std::min(first + 1, n - 1), static_cast<float>(at - below)};
}

void sample_linearly(const Image& image, const glm::dvec2& place, float* out) {
    const bool inside = place.x >= 0.0 && place.y >= 0.0 && place.x <= static_cast<double>(image.width) &&
                        place.y <= static_cast<double>(image.height);
    if (!inside) return;
    const Neighbours x = neighbours(place.x, image.width), y = neighbours(place.y, image.height);
    const float* const a = image.at(x.first, y.first);
    const float* const b = image.at(x.second, y.first);
    const float* const c = image.at(x.first, y.second);
    const float* const d = image.at(x.second, y.second);
    for (int i = 0; i < image.channels; ++i) {
        const float top = a[i] + (b[i] - a[i]) * x.share, bottom = c[i] + (d[i] - c[i]) * x.share;
        out[i] = top + (bottom - top) * y.share;
    }
}

}  // namespace

PixelMap map_to_width(const Image& image, std::int64_t width, std::int64_t height) {
    const double scale = static_cast<double>(image.width) / static_cast<double>(width);
    PixelMap map;
    map.linear *= scale;
    map.offset.y = 0.5 * (static_cast<double>(image.height) - scale * static_cast<double>(height));
    return map;
}

Image resampled(const Image& image, const PixelMap& texel_from_pixel, std::int64_t width, std::int64_t height,
                double sigma_px) {
    const double texels_per_pixel = std::sqrt(std::fabs(glm::determinant(texel_from_pixel.linear)));
    const Image filtered = convolved_with_gaussian(image, sigma_px * texels_per_pixel);
    Image out = make_image(width, height, image.channels);
    parallel_each(height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < width; ++x) {
            const glm::dvec2 center(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
            sample_linearly(filtered, texel_from_pixel.offset + texel_from_pixel.linear * center,
                            out.at(x, y));
        }
    });
    return out;
}

}  // namespace astrosplat
