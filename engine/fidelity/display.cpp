#include "fidelity/display.h"

#include <algorithm>
#include <cassert>

#include "core/color.h"
#include "core/parallel.h"

namespace astrosplat {
namespace {

// A picture of `channels` whose pixels are made of those of `from`: make(in, out).
template <class PerPixel>
Image made_of(const Image& from, int channels, const PerPixel& make) {
    assert(from.channels >= 3);
    Image image{from.width, from.height, channels, {}};
    image.pixels.resize(static_cast<std::size_t>(from.width * from.height * channels));
    parallel_each(from.width * from.height, 1 << 14, [&](std::int64_t i) {
        make(from.pixels.data() + i * from.channels, image.pixels.data() + i * channels);
    });
    return image;
}

}  // namespace

Image display_colors(const Image& linear) {
    return made_of(linear, 3, [](const float* in, float* out) {
        for (int c = 0; c < 3; ++c) out[c] = display_srgb(in[c]);
    });
}

Image display_mean(const Image& linear) {
    return made_of(linear, 1, [](const float* in, float* out) {
        *out = (display_srgb(in[0]) + display_srgb(in[1]) + display_srgb(in[2])) / 3.0f;
    });
}

Image display_max(const Image& linear) {
    return made_of(linear, 1, [](const float* in, float* out) {
        *out = display_srgb(std::max({in[0], in[1], in[2]}));
    });
}

Image inner_colors(const Image& linear, std::int64_t margin_px) {
    const std::int64_t margin = std::min({margin_px, (linear.width - 1) / 2, (linear.height - 1) / 2});
    Image inner = make_image(linear.width - 2 * margin, linear.height - 2 * margin, 3);
    for (std::int64_t y = 0; y < inner.height; ++y)
        for (std::int64_t x = 0; x < inner.width; ++x)
            std::copy_n(linear.at(x + margin, y + margin), 3, inner.at(x, y));
    return inner;
}

}  // namespace astrosplat
