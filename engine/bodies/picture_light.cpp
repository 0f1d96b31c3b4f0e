#include "bodies/picture_light.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_per_chunk = 16;

// 0 at the edge, 1 from `width` px inwards.
float edge_fade(std::int64_t i, std::int64_t count, double width) {
    if (width <= 0.0) return 1.0f;
    const double inside = std::min(double(i) + 0.5, double(count - i) - 0.5) / width;
    const double t = std::clamp(inside, 0.0, 1.0);
    return static_cast<float>(t * t * (3.0 - 2.0 * t));
}

float finite_light(float value) { return value > 0.0f && std::isfinite(value) ? value : 0.0f; }

}  // namespace

PictureLight picture_light(const Texture& texture, double border) {
    const Image& image = texture.image;
    const double width_px = border * static_cast<double>(image.width);
    PictureLight result{unfilled_image(image.width, image.height, 3),
                        unfilled_image(image.width, image.height, 1), texture.times > 1};
    parallel_chunks(image.height, rows_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t y = begin; y < end; ++y) {
            const float fade_y = edge_fade(y, image.height, width_px);
            for (std::int64_t x = 0; x < image.width; ++x) {
                const float fade = fade_y * edge_fade(x, image.width, width_px);
                const float* const in = image.at(x, y);
                for (int c = 0; c < 3; ++c) result.light.at(x, y)[c] = fade * finite_light(in[c]);
                *result.alpha.at(x, y) =
                    texture.alpha_from_light ? fade : fade * std::clamp(finite_light(in[3]), 0.0f, 1.0f);
            }
        }
    });
    if (std::all_of(result.alpha.pixels.begin(), result.alpha.pixels.end(),
                    [](float a) { return a == 1.0f; }))
        result.alpha = {};
    return result;
}

}  // namespace astrosplat
