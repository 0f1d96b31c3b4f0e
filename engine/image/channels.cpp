#include "image/channels.h"

#include <algorithm>
#include <cassert>

#include "core/parallel.h"

namespace astrosplat {

Image copied(const Image& image) {
    Image copy = unfilled_image(image.width, image.height, image.channels);
    parallel_chunks(static_cast<std::int64_t>(image.pixels.size()), 65536,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        std::copy(image.pixels.begin() + begin, image.pixels.begin() + end,
                                  copy.pixels.begin() + begin);
                    });
    return copy;
}

Image brightest_channel(const Image& light) {
    Image brightest = unfilled_image(light.width, light.height, 1);
    parallel_chunks(light.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * light.width; i < end * light.width; ++i) {
            const float* const p = light.pixels.data() + i * light.channels;
            brightest.pixels[static_cast<std::size_t>(i)] = std::max({p[0], p[1], p[2]});
        }
    });
    return brightest;
}

Image mean_of_channels(const Image& image) {
    assert(image.channels >= 3);
    Image mean = make_image(image.width, image.height, 1);
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            const float* const p = image.at(x, y);
            *mean.at(x, y) = (p[0] + p[1] + p[2]) / 3.0f;
        }
    });
    return mean;
}

Image channel_of(const Image& image, int channel) {
    Image one = unfilled_image(image.width, image.height, 1);
    parallel_chunks(image.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * image.width; i < end * image.width; ++i)
            one.pixels[static_cast<std::size_t>(i)] =
                image.pixels[static_cast<std::size_t>(i * image.channels + channel)];
    });
    return one;
}

}  // namespace astrosplat
