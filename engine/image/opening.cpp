// Least and largest of windows along rows and then columns; each by doubling: from windows of n to such of
// 2n.
#include "image/opening.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr std::int64_t columns_per_strip = 32;

// Replaces each of `count` values, groups of `width` floats, by the extreme of those up to `reach` away.
// `line`: room for count + 2 reach groups.
template <class Extreme>
void filter_line(std::vector<float>& line, std::int64_t count, std::int64_t width, std::int64_t reach,
                 Extreme extreme) {
    const std::int64_t total = count + 2 * reach, window = 2 * reach + 1;
    for (std::int64_t i = 0; i < reach; ++i) {
        std::copy_n(line.begin() + reach * width, width, line.begin() + i * width);
        std::copy_n(line.begin() + (reach + count - 1) * width, width,
                    line.begin() + (reach + count + i) * width);
    }
    const auto join = [&](std::int64_t size,
                          std::int64_t shift) {  // windows of `size` + `shift` from such of `size`
        const std::int64_t values = (total - size - shift + 1) * width;
        float* const to = line.data();
        const float* const from = to + shift * width;
        for (std::int64_t i = 0; i < values; ++i) to[i] = extreme(to[i], from[i]);
    };
    std::int64_t size = 1;
    for (; 2 * size <= window; size *= 2) join(size, size);
    if (size < window) join(size, window - size);
}

template <class Extreme>
void filter(Image& image, std::int64_t reach, Extreme extreme) {
    parallel_chunks(image.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<float> line(static_cast<std::size_t>(image.width + 2 * reach));
        for (std::int64_t y = begin; y < end; ++y) {
            std::copy_n(image.at(0, y), image.width, line.begin() + reach);
            filter_line(line, image.width, 1, reach, extreme);
            std::copy_n(line.begin(), image.width, image.at(0, y));
        }
    });
    parallel_chunks(image.width, columns_per_strip, [&](std::int64_t begin, std::int64_t end, int) {
        const std::int64_t width = end - begin;
        std::vector<float> line(static_cast<std::size_t>((image.height + 2 * reach) * width));
        for (std::int64_t y = 0; y < image.height; ++y)
            std::copy_n(image.at(begin, y), width, line.begin() + (reach + y) * width);
        filter_line(line, image.height, width, reach, extreme);
        for (std::int64_t y = 0; y < image.height; ++y)
            std::copy_n(line.begin() + y * width, width, image.at(begin, y));
    });
}

}  // namespace

Image opened(Image image, std::int64_t reach_px) {
    assert(image.channels == 1 && reach_px >= 0);
    if (image.pixels.empty()) return image;
    filter(image, reach_px, [](float a, float b) { return std::min(a, b); });
    filter(image, reach_px, [](float a, float b) { return std::max(a, b); });
    return image;
}

}  // namespace astrosplat
