// Channels of images. In: an image in memory. Out: one channel of it or all, or a value between its pixels.
#pragma once

#include <algorithm>

#include "core/image.h"
#include "core/parallel.h"

namespace astrosplat {

/// An image of as many pixels, each made of the one of `from` there: make(in, out), on all threads.
template <class PerPixel>
Image made_by_pixel(const Image& from, int channels, const PerPixel& make) {
    Image image = unfilled_image(from.width, from.height, channels);
    parallel_each(from.width * from.height, 1 << 14, [&](std::int64_t i) {
        make(from.pixels.data() + i * from.channels, image.pixels.data() + i * channels);
    });
    return image;
}

/// A copy made by all threads: one alone would take as long to fetch its memory as to fill it.
Image copied(const Image& image);

/// max(R, G, B) of every pixel.
Image brightest_channel(const Image& light);

/// The mean of the first three channels.
Image mean_of_channels(const Image& image);

/// One channel alone.
Image channel_of(const Image& image, int channel);

/// A place (x, y) px from the top left corner in images of the size of `like`: values there are linear
/// between pixel centres, and beyond the outermost ones the same as these.
class LinearSample {
  public:
    LinearSample(const Image& like, float x, float y) {
        const float fx = std::clamp(x - 0.5f, 0.0f, static_cast<float>(like.width - 1));
        const float fy = std::clamp(y - 0.5f, 0.0f, static_cast<float>(like.height - 1));
        const auto x0 = static_cast<std::int64_t>(fx), y0 = static_cast<std::int64_t>(fy);
        pixel_ = y0 * like.width + x0;
        right_ = x0 + 1 < like.width ? 1 : 0;
        down_ = y0 + 1 < like.height ? like.width : 0;
        tx_ = fx - static_cast<float>(x0);
        ty_ = fy - static_cast<float>(y0);
    }

    float of(const Image& image, int channel = 0) const {
        const float* const p = image.pixels.data() + pixel_ * image.channels + channel;
        const float* const q = p + down_ * image.channels;
        const std::int64_t right = right_ * image.channels;
        const float top = p[0] * (1.0f - tx_) + p[right] * tx_;
        const float bottom = q[0] * (1.0f - tx_) + q[right] * tx_;
        return top * (1.0f - ty_) + bottom * ty_;
    }

  private:
    std::int64_t pixel_, right_, down_;  // pixels: the upper left one, and to its neighbours
    float tx_, ty_;                      // shares of these
};

inline float bilinear(const Image& image, int channel, float x, float y) {
    return LinearSample(image, x, y).of(image, channel);
}

}  // namespace astrosplat
