// Pixels of images and their channels. In: an image in memory. Out: one channel of it or all, a value between
// its pixels, or a visit to all of them or to those about a place.
#pragma once

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

/// Its pixels in a region that lies within it.
Image part_of(const Image& image, const Region& region);

/// max(R, G, B) of every pixel.
Image brightest_channel(const Image& light);

/// The mean of the first three channels.
Image mean_of_channels(const Image& image);

/// The first three channels, and an alpha of 1.
Image opaque(const Image& image);

/// One channel alone.
Image channel_of(const Image& image, int channel);

/// Seen as one of the eight values of EXIF's and TIFF's tag Orientation, from 1, means it to be.
Image turned(const Image& image, int orientation);

/// A place (x, y) px from the top left corner in images of the size of `like`: values there are linear
/// between pixel centres, and beyond the outermost ones the same as these.
class LinearSample {
  public:
    LinearSample(const Image& like, float x, float y) {
        const float fx = std::clamp(x - 0.5f, 0.0f, float(like.width - 1));
        const float fy = std::clamp(y - 0.5f, 0.0f, float(like.height - 1));
        const auto x0 = std::int64_t(fx), y0 = std::int64_t(fy);
        pixel_ = y0 * like.width + x0;
        right_ = x0 + 1 < like.width ? 1 : 0;
        down_ = y0 + 1 < like.height ? like.width : 0;
        tx_ = fx - float(x0);
        ty_ = fy - float(y0);
    }

    float of(const Image& image, int channel = 0) const {
        const float* const p = image.pixels.data() + pixel_ * image.channels + channel;
        const float* const q = p + down_ * image.channels;
        const std::int64_t right = right_ * image.channels;
        const float top = p[0] * (1.0f - tx_) + p[right] * tx_;
        const float bottom = q[0] * (1.0f - tx_) + q[right] * tx_;
        return top * (1.0f - ty_) + bottom * ty_;
    }

    /// Of max(R, G, B), or of the only channel.
    float brightest_of(const Image& image) const {
        const std::int64_t n = image.channels;
        const auto at = [&](std::int64_t pixel) {
            const float* const p = image.pixels.data() + pixel * n;
            return n < 3 ? p[0] : std::max({p[0], p[1], p[2]});
        };
        const std::int64_t below = pixel_ + down_;
        const float top = at(pixel_) * (1.0f - tx_) + at(pixel_ + right_) * tx_;
        const float bottom = at(below) * (1.0f - tx_) + at(below + right_) * tx_;
        return top * (1.0f - ty_) + bottom * ty_;
    }

  private:
    std::int64_t pixel_, right_, down_;  // pixels: the upper left one, and to its neighbours
    float tx_, ty_;                      // shares of these
};

inline float bilinear(const Image& image, int channel, float x, float y) {
    return LinearSample(image, x, y).of(image, channel);
}

/// Calls visit(x, y) for every pixel, on all threads.
template <class Visit>
void for_each_pixel(const Image& image, const Visit& visit) {
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) visit(x, y);
    });
}

/// Calls change(p) with the channels of every pixel, on all threads.
template <class Change>
void change_pixels(Image& image, const Change& change) {
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) { change(image.at(x, y)); });
}

/// Calls visit(x, y) for the pixels of the rectangle from one corner to the other, both included, that an
/// image (of any type with width and height) has: row by row, on this thread.
template <class Pixels, class Visit>
void for_each_between(const Pixels& pixels, std::int64_t left, std::int64_t top, std::int64_t right,
                      std::int64_t bottom, const Visit& visit) {
    for (std::int64_t y = std::max<std::int64_t>(0, top); y <= std::min(pixels.height - 1, bottom); ++y)
        for (std::int64_t x = std::max<std::int64_t>(0, left); x <= std::min(pixels.width - 1, right); ++x)
            visit(x, y);
}

/// Those of the square of `reach_px` about a pixel.
template <class Pixels, class Visit>
void for_each_about(const Pixels& pixels, std::int64_t x, std::int64_t y, std::int64_t reach_px,
                    const Visit& visit) {
    for_each_between(pixels, x - reach_px, y - reach_px, x + reach_px, y + reach_px, visit);
}

/// visit(x, y, dx, dy) of those whose middles lie within `radius_px` of a place, px from the top left corner;
/// dx and dy lead from there to the pixel's middle.
template <class Pixels, class Visit>
void for_each_within(const Pixels& pixels, double at_x, double at_y, double radius_px, const Visit& visit) {
    const auto whole = [](double v) { return std::int64_t(v); };
    for_each_between(pixels, whole(at_x - radius_px), whole(at_y - radius_px), whole(at_x + radius_px),
                     whole(at_y + radius_px), [&](std::int64_t x, std::int64_t y) {
                         const double dx = double(x) + 0.5 - at_x, dy = double(y) + 0.5 - at_y;
                         if (dx * dx + dy * dy <= radius_px * radius_px) visit(x, y, dx, dy);
                     });
}

}  // namespace astrosplat
