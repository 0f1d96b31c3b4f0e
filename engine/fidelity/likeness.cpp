#include "fidelity/likeness.h"

#include <cassert>
#include <cmath>

#include "core/real.h"
#include "fidelity/display.h"
#include "image/blur.h"
#include "image/row_sums.h"

namespace astrosplat {
namespace {

constexpr double least_square_error = 1e-12;
constexpr double window_px = 1.5;
constexpr double luminance_constant = 1e-4, contrast_constant = 9e-4;

void require_same_size([[maybe_unused]] const Image& a, [[maybe_unused]] const Image& b) {
    assert(a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0);
}

// Five channels a, b, a^2, b^2, ab, whose blurs hold all that the measure needs.
Image products(const Image& a, const Image& b) {
    Image all = make_image(a.width, a.height, 5);
    for (std::int64_t i = 0; i < a.width * a.height; ++i) {
        const float x = a.pixels[static_cast<std::size_t>(i)], y = b.pixels[static_cast<std::size_t>(i)];
        float* const p = all.pixels.data() + 5 * i;
        p[0] = x, p[1] = y, p[2] = x * x, p[3] = y * y, p[4] = x * y;
    }
    return all;
}

double ssim_of_pixel(const float* p) {
    const double a = p[0], b = p[1];
    const double variances = (p[2] - a * a) + (p[3] - b * b), covariance = p[4] - a * b;
    return (2.0 * a * b + luminance_constant) * (2.0 * covariance + contrast_constant) /
           ((a * a + b * b + luminance_constant) * (variances + contrast_constant));
}

}  // namespace

double psnr_db(const Image& a, const Image& b) {
    require_same_size(a, b);
    const Image x = display_colors(a), y = display_colors(b);
    const std::int64_t row = x.width * 3;
    const double squares = sum_over_rows(x.height, [&](std::int64_t j) {
        double sum = 0.0;
        for (std::int64_t i = 0; i < row; ++i) {
            const double d = static_cast<double>(x.at(0, j)[i]) - static_cast<double>(y.at(0, j)[i]);
            sum += d * d;
        }
        return sum;
    });
    return -10.0 * real::log(squares / static_cast<double>(x.pixels.size()) + least_square_error) /
           real::log(10.0);
}

double ssim(const Image& a, const Image& b) {
    require_same_size(a, b);
    const Image blurred = convolved_with_gaussian(products(display_mean(a), display_mean(b)), window_px);
    const double sum = sum_over_rows(blurred.height, [&](std::int64_t y) {
        double row = 0.0;
        for (std::int64_t x = 0; x < blurred.width; ++x) row += ssim_of_pixel(blurred.at(x, y));
        return row;
    });
    return sum / static_cast<double>(blurred.width * blurred.height);
}

}  // namespace astrosplat
