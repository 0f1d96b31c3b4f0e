#include "fidelity/front.h"

#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "image/blur.h"

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
        const float x = a.pixels[i], y = b.pixels[i];
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

using ChannelSums = std::array<double, 3>;

ChannelSums cell_light(const Image& image, std::int64_t column, std::int64_t row) {
    ChannelSums sums{};
    const auto begin = [](std::int64_t cell, std::int64_t size) { return cell * size / flux_cells; };
    for (std::int64_t y = begin(row, image.height); y < begin(row + 1, image.height); ++y)
        for (std::int64_t x = begin(column, image.width); x < begin(column + 1, image.width); ++x)
            for (int c = 0; c < 3; ++c) sums[c] += image.at(x, y)[c];
    return sums;
}

std::vector<ChannelSums> light_of_cells(const Image& image) {
    std::vector<ChannelSums> cells(std::size_t(flux_cells * flux_cells));
    parallel_for(flux_cells, [&](std::int64_t row, int) {
        for (std::int64_t column = 0; column < flux_cells; ++column)
            cells[row * flux_cells + column] = cell_light(image, column, row);
    });
    return cells;
}

double ratio(double light, double of) {
    return of > 0.0 ? light / of : std::numeric_limits<double>::quiet_NaN();
}

double total(const ChannelSums& sums) { return sums[0] + sums[1] + sums[2]; }

constexpr double least_power = 1e-14;  // what rounding leaves of an image without detail

double mean_square_difference(const Image& a, const Image& b) {
    const double sum = sum_over_rows(a.height, [&](std::int64_t y) {
        double row = 0.0;
        for (std::int64_t x = 0; x < a.width; ++x) {
            const double d = double(*a.at(x, y)) - double(*b.at(x, y));
            row += d * d;
        }
        return row;
    });
    return sum / double(a.width * a.height);
}

// The mean square of each band: those between the blurs by 0, 1, 2, 4 ... `widest` px.
std::vector<double> band_powers(const Image& image, double widest) {
    const Image whole = display_mean(image);
    Image finer = whole;
    std::vector<double> powers;
    for (double sigma = 1.0; sigma <= widest; sigma *= 2.0) {
        Image coarser = gaussian_blur(whole, sigma);
        powers.push_back(mean_square_difference(finer, coarser));
        finer = std::move(coarser);
    }
    return powers;
}

}  // namespace

double psnr_db(const Image& a, const Image& b) {
    require_same_size(a, b);
    const Image x = display_colors(a), y = display_colors(b);
    const std::int64_t row = x.width * 3;
    const double squares = sum_over_rows(x.height, [&](std::int64_t j) {
        double sum = 0.0;
        for (std::int64_t i = 0; i < row; ++i) {
            const double d = double(x.at(0, j)[i]) - double(y.at(0, j)[i]);
            sum += d * d;
        }
        return sum;
    });
    return -10.0 * real::log(squares / double(x.pixels.size()) + least_square_error) / real::log(10.0);
}

double ssim(const Image& a, const Image& b) {
    require_same_size(a, b);
    const Image blurred = convolved_with_gaussian(products(display_mean(a), display_mean(b)), window_px);
    const double sum = sum_over_rows(blurred.height, [&](std::int64_t y) {
        double row = 0.0;
        for (std::int64_t x = 0; x < blurred.width; ++x) row += ssim_of_pixel(blurred.at(x, y));
        return row;
    });
    return sum / double(blurred.width * blurred.height);
}

FluxRatios flux_ratios(const Image& view, const Image& reference) {
    assert(view.width == reference.width && view.height == reference.height);
    const std::vector<ChannelSums> ours = light_of_cells(view), theirs = light_of_cells(reference);
    const double cell_samples = 3.0 * double(view.width * view.height) / double(ours.size());
    FluxRatios result;
    ChannelSums our_sum{}, their_sum{};
    std::vector<double> lit;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            our_sum[c] += ours[i][c];
            their_sum[c] += theirs[i][c];
        }
        const bool dark = total(theirs[i]) < darkest_cell * cell_samples;
        result.cells.push_back(dark ? std::numeric_limits<double>::quiet_NaN()
                                    : ratio(total(ours[i]), total(theirs[i])));
        if (!std::isnan(result.cells.back())) lit.push_back(result.cells.back());
    }
    for (std::size_t c = 0; c < 3; ++c) result.channels[c] = ratio(our_sum[c], their_sum[c]);
    result.frame = ratio(total(our_sum), total(their_sum));
    result.cells_5 = percentile(lit, 0.05);
    result.cells_50 = percentile(lit, 0.5);
    result.cells_95 = percentile(lit, 0.95);
    return result;
}

std::vector<ScalePower> power_by_scale(const Image& view, const Image& reference) {
    assert(view.width == reference.width && view.height == reference.height);
    const double widest = double(std::min(view.width, view.height)) / 8.0;
    const std::vector<double> ours = band_powers(view, widest), theirs = band_powers(reference, widest);
    std::vector<ScalePower> bands;
    double finer = 0.0, coarser = 1.0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const bool detail = theirs[i] > least_power;
        bands.push_back(
            {finer, coarser, detail ? ours[i] / theirs[i] : std::numeric_limits<double>::quiet_NaN()});
        finer = coarser;
        coarser *= 2.0;
    }
    return bands;
}

FrontFidelity front_fidelity(const Image& rendered, const Image& reference, double border) {
    assert(rendered.width == reference.width && rendered.height == reference.height);
    const auto margin = std::int64_t(border * double(rendered.width) + 0.5);
    const Image ours = inner_colors(rendered, margin), theirs = inner_colors(reference, margin);
    FrontFidelity result;
    result.width_px = rendered.width;
    result.height_px = rendered.height;
    result.psnr_db = psnr_db(ours, theirs);
    result.ssim = ssim(ours, theirs);
    result.flux = flux_ratios(ours, theirs);
    result.ciede2000 = color_differences(ours, theirs);
    result.power = power_by_scale(ours, theirs);
    return result;
}

// The cropped images, and the five channels of ssim with two copies on their way through a blur.
std::int64_t front_fidelity_bytes(std::int64_t width_px, std::int64_t height_px) {
    constexpr std::int64_t floats_per_pixel = 2 * 3 + 3 * 5;
    return width_px * height_px * floats_per_pixel * std::int64_t(sizeof(float));
}

}  // namespace astrosplat
