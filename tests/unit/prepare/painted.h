// Pictures painted from formulas, with noise that is the same on every run.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/image.h"

namespace astrosplat {

/// value(x, y, channel) at every pixel's centre; places in px from the top left corner.
template <class Value>
Image painted(std::int64_t width, std::int64_t height, int channels, const Value& value) {
    Image image = make_image(width, height, channels);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y)[c] =
                    static_cast<float>(value(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, c));
    return image;
}

/// Uniform in [0, 1), one number a call.
struct Random {
    std::uint64_t state;

    double operator()() {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state >> 11) / 9007199254740992.0;
    }
    /// Of mean 0 and standard deviation 1 (the sum of twelve).
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) sum += (*this)();
        return sum;
    }
};

inline Image add_noise(Image image, double deviation, std::uint64_t seed) {
    Random random{seed};
    for (float& value : image.pixels) value += static_cast<float>(deviation * random.normal());
    return image;
}

}  // namespace astrosplat
