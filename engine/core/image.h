// An image in memory: rows from the top, interleaved float channels. Unless a comment says otherwise: linear
// light, Rec. 709 primaries, premultiplied by alpha.
#pragma once

#include "core/buffer.h"

namespace astrosplat {

struct Image {
    std::int64_t width = 0;   // px
    std::int64_t height = 0;  // px
    int channels = 0;
    Buffer<float> pixels;  // width * height * channels

    float* at(std::int64_t x, std::int64_t y) { return pixels.data() + (y * width + x) * channels; }
    const float* at(std::int64_t x, std::int64_t y) const {
        return pixels.data() + (y * width + x) * channels;
    }
};

inline Image make_image(std::int64_t width, std::int64_t height, int channels, float value = 0.0f) {
    Image image{width, height, channels, {}};
    image.pixels.assign(std::size_t(width * height * channels), value);
    return image;
}

/// Without a value: whoever writes a pixel first takes its memory.
inline Image unfilled_image(std::int64_t width, std::int64_t height, int channels) {
    Image image{width, height, channels, {}};
    image.pixels.resize(std::size_t(width * height * channels));
    return image;
}

/// Part of an image plane in pixels, from the top left; empty when width or height is 0.
struct Region {
    std::int64_t x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Region&) const = default;
};

}  // namespace astrosplat
