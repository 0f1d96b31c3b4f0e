// Pictures for the measures, drawn by formulas that any language can repeat: linear light, three channels.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/image.h"

namespace astrosplat {

/// color(x, y, channel) at every pixel.
template <class Color>
Image drawn(std::int64_t width, std::int64_t height, const Color& color) {
    Image image = make_image(width, height, 3);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(color(x, y, c));
    return image;
}

/// Waves and 25 stars on 240 x 160 units, at a place in units.
inline double waves_and_stars(double x, double y, int c) {
    double value = 0.05 + 0.12 * (1.0 + std::sin(0.11 * x + c) * std::cos(0.07 * y - c));
    for (int k = 0; k < 25; ++k) {
        const double dx = x - (13 + (k * 97) % 214), dy = y - (11 + (k * 61) % 138),
                     sigma = 1.2 + 0.2 * (k % 4);
        const double share = c == 0 ? 1.0 : c == 1 ? 0.9 : 0.7 + 0.1 * (k % 3);
        value += share * (0.1 + 0.03 * (k % 9)) * std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
    }
    return value;
}

/// The same as a picture of 240 x 160 px times `scale`.
inline Image waves_and_stars(int scale) {
    return drawn(240 * scale, 160 * scale, [&](std::int64_t x, std::int64_t y, int c) {
        return waves_and_stars((static_cast<double>(x) + 0.5) / scale, (static_cast<double>(y) + 0.5) / scale,
                               c);
    });
}

/// As a renderer might show it: rippled by 5 % and with a little noise.
inline Image rendered_waves_and_stars() {
    return drawn(240, 160, [&](std::int64_t x, std::int64_t y, int c) {
        const auto i = static_cast<double>(x), j = static_cast<double>(y);
        const double noise = static_cast<double>((x * 7919 + y * 104729 + c * 1299709) % 1000) / 1000.0 - 0.5;
        return waves_and_stars(i + 0.5, j + 0.5, c) * (1.0 + 0.05 * std::sin(0.9 * i + 1.3 * j)) +
               0.01 * noise;
    });
}

}  // namespace astrosplat
