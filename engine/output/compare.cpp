// Differences of two images, in one pass over the rows and one selection for the percentile.
#include "output/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/real.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

double difference(float a, float b) {
    if (same_bits(a, b)) return 0.0;
    double d = std::fabs(static_cast<double>(a) - static_cast<double>(b));
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

double percentile(std::vector<double>& values, double share) {
    if (values.empty()) return 0.0;
    auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
    auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double psnr(double mean_square) {
    if (mean_square == 0.0) return std::numeric_limits<double>::infinity();
    return -10.0 * real::log(mean_square) / real::log(10.0);
}

}  // namespace

ImageComparison compare_images(const Image& a, const Image& b) {
    assert(a.width == b.width && a.height == b.height && a.channels == b.channels);
    ImageComparison result;
    result.width = a.width;
    result.height = a.height;
    std::vector<double> of_pixel(static_cast<std::size_t>(a.width * a.height), 0.0);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < of_pixel.size(); ++i) {
        bool differs = false;
        for (int c = 0; c < a.channels; ++c) {
            std::size_t k = i * static_cast<std::size_t>(a.channels) + static_cast<std::size_t>(c);
            double d = difference(a.pixels[k], b.pixels[k]);
            differs = differs || !same_bits(a.pixels[k], b.pixels[k]);
            sum += d;
            squares += d * d;
            of_pixel[i] = std::fmax(of_pixel[i], d);
            if (!(d > result.max_difference)) continue;
            result.max_difference = d;
            result.max_x = static_cast<std::int64_t>(i) % a.width;
            result.max_y = static_cast<std::int64_t>(i) / a.width;
            result.max_channel = c;
        }
        if (differs) ++result.differing_pixels;
    }
    double values = std::fmax(1.0, static_cast<double>(a.pixels.size()));
    result.mean_difference = sum / values;
    result.psnr_db = psnr(squares / values);
    result.percentile_999 = percentile(of_pixel, 0.999);
    return result;
}

ImageComparison compare_files(const std::filesystem::path& a, const std::filesystem::path& b) {
    Image first = load_linear_image(a), second = load_linear_image(b);
    if (first.width != second.width || first.height != second.height)
        bad_input(b.string(), "",
                  fmt::format("{} x {} pixels as in {}", first.width, first.height, a.string()),
                  fmt::format("{} x {}", second.width, second.height));
    return compare_images(first, second);
}

}  // namespace astrosplat
