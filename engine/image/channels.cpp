#include "image/channels.h"

namespace astrosplat {

Image copied(const Image& image) {
    Image copy = unfilled_image(image.width, image.height, image.channels);
    parallel_chunks(std::int64_t(image.pixels.size()), 65536, [&](std::int64_t begin, std::int64_t end, int) {
        std::copy(image.pixels.begin() + begin, image.pixels.begin() + end, copy.pixels.begin() + begin);
    });
    return copy;
}

Image part_of(const Image& image, const Region& region) {
    Image part = unfilled_image(region.width, region.height, image.channels);
    parallel_each(region.height, 64, [&](std::int64_t y) {
        std::copy_n(image.at(region.x, region.y + y), region.width * image.channels, part.at(0, y));
    });
    return part;
}

Image brightest_channel(const Image& light) {
    if (light.channels < 3) return channel_of(light, 0);
    return made_by_pixel(light, 1, [](const float* in, float* out) {
        *out = std::max({in[0], in[1], in[2]});
    });
}

Image mean_of_channels(const Image& image) {
    return made_by_pixel(image, 1,
                         [](const float* in, float* out) { *out = (in[0] + in[1] + in[2]) / 3.0f; });
}

Image opaque(const Image& image) {
    Image rgba = make_image(image.width, image.height, 4, 1.0f);
    for_each_pixel(image,
                   [&](std::int64_t x, std::int64_t y) { std::copy_n(image.at(x, y), 3, rgba.at(x, y)); });
    return rgba;
}

Image channel_of(const Image& image, int channel) {
    return made_by_pixel(image, 1, [=](const float* in, float* out) { *out = in[channel]; });
}

Image turned(const Image& image, int orientation) {
    const bool swaps = orientation >= 5;  // rows become columns
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
    const bool from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    Image result =
        make_image(swaps ? image.height : image.width, swaps ? image.width : image.height, image.channels);
    for_each_pixel(result, [&](std::int64_t x, std::int64_t y) {
        const std::int64_t column = swaps ? y : x, row = swaps ? x : y;
        std::copy_n(image.at(from_right ? image.width - 1 - column : column,
                             from_below ? image.height - 1 - row : row),
                    image.channels, result.at(x, y));
    });
    return result;
}

}  // namespace astrosplat
