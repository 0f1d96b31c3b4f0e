#include "image/channels.h"

#include <algorithm>

#include "core/parallel.h"

namespace astrosplat {

Image brightest_channel(const Image& light) {
    Image brightest = make_image(light.width, light.height, 1);
    parallel_chunks(light.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * light.width; i < end * light.width; ++i) {
            const float* const p = light.pixels.data() + i * light.channels;
            brightest.pixels[static_cast<std::size_t>(i)] = std::max({p[0], p[1], p[2]});
        }
    });
    return brightest;
}

float bilinear(const Image& image, int channel, float x, float y) {
    const float fx = std::clamp(x - 0.5f, 0.0f, static_cast<float>(image.width - 1));
    const float fy = std::clamp(y - 0.5f, 0.0f, static_cast<float>(image.height - 1));
    const auto x0 = static_cast<std::int64_t>(fx), y0 = static_cast<std::int64_t>(fy);
    const std::int64_t x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
    const float tx = fx - static_cast<float>(x0), ty = fy - static_cast<float>(y0);
    const float top = image.at(x0, y0)[channel] * (1.0f - tx) + image.at(x1, y0)[channel] * tx;
    const float bottom = image.at(x0, y1)[channel] * (1.0f - tx) + image.at(x1, y1)[channel] * tx;
    return top * (1.0f - ty) + bottom * ty;
}

}  // namespace astrosplat
