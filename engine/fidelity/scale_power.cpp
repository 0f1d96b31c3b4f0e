#include "fidelity/scale_power.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "fidelity/display.h"
#include "image/blur.h"
#include "image/row_sums.h"

namespace astrosplat {
namespace {

constexpr double least_power = 1e-14;  // what rounding leaves of a picture without detail

double mean_square_difference(const Image& a, const Image& b) {
    const double sum = sum_over_rows(a.height, [&](std::int64_t y) {
        double row = 0.0;
        for (std::int64_t x = 0; x < a.width; ++x) {
            const double d = static_cast<double>(*a.at(x, y)) - static_cast<double>(*b.at(x, y));
            row += d * d;
        }
        return row;
    });
    return sum / static_cast<double>(a.width * a.height);
}

// The mean square of each band: those between the blurs by 0, 1, 2, 4 ... `widest` px.
std::vector<double> band_powers(const Image& picture, double widest) {
    const Image whole = display_mean(picture);
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

std::vector<ScalePower> power_by_scale(const Image& picture, const Image& reference) {
    assert(picture.width == reference.width && picture.height == reference.height);
    const double widest = static_cast<double>(std::min(picture.width, picture.height)) / 8.0;
    const std::vector<double> ours = band_powers(picture, widest), theirs = band_powers(reference, widest);
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

}  // namespace astrosplat
