// The flat light of a picture's dots against closed forms and against the renderer's.
#include "bodies/flat_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/real.h"
#include "support/painted_picture.h"

namespace astrosplat {
namespace {

constexpr std::int64_t width = 96, height = 64;
constexpr double filter_px = 0.5;

// Dots of three sizes all over the picture, in rows, and one of dust.
PictureSplats some_dots() {
    PictureSplats dots;
    std::uint32_t n = 0;
    for (const float sigma : {0.5f, 1.7f, 6.0f}) {
        const auto begin = dots.splats.size();
        for (int i = 0; i < 300; ++i, ++n) {
            const auto x = static_cast<float>((painted::random(n, 1) - 0.5) * static_cast<double>(width));
            dots.splats.position.emplace_back(x, 31.9f - 0.21f * static_cast<float>(i), 0.0f);
            dots.splats.color.emplace_back(1.0f, 0.5f, static_cast<float>(painted::random(n, 2)));
            dots.splats.alpha.push_back(0.1f);
            dots.splats.radius.push_back(radius_sigmas * sigma);
        }
        dots.ranges.push_back({begin, dots.splats.size(), sigma});
    }
    dots.splats.position.emplace_back(0.0f);
    dots.splats.color.emplace_back(-1.0f);
    dots.splats.alpha.push_back(0.5f);
    dots.splats.radius.push_back(4.0f);
    return dots;
}

PictureSplats one_dot(float x, float y, float sigma) {
    PictureSplats dots;
    dots.splats.position.emplace_back(x, y, 0.0f);
    dots.splats.color.emplace_back(0.0f, 2.0f, 0.0f);
    dots.splats.alpha.push_back(0.25f);
    dots.splats.radius.push_back(radius_sigmas * sigma);
    dots.ranges.push_back({0, 1, sigma});
    return dots;
}

// Flux, centre and variance along the axes of one dot, on every grid.
TEST(FlatLight, OneDotIsItsFootprint) {
    for (const double sigma : {0.45, 0.5, 0.6, 0.75, 0.9, 1.3, 3.0, 7.0}) {
        PictureSplats dots = one_dot(3.3f, -5.6f, static_cast<float>(sigma));
        const Image light = FlatLight(dots, width, height, filter_px).sum();
        double sum = 0.0, x_sum = 0.0, y_sum = 0.0, squares = 0.0;
        for (std::int64_t y = 0; y < height; ++y) {
            for (std::int64_t x = 0; x < width; ++x) {
                const auto value = static_cast<double>(light.at(x, y)[1]);
                const double dx = static_cast<double>(x) + 0.5 - (48.0 + 3.3),
                             dy = static_cast<double>(y) + 0.5 - (32.0 + 5.6);
                sum += value;
                x_sum += value * dx;
                y_sum += value * dy;
                squares += value * (dx * dx + dy * dy);
            }
        }
        const double flux = 0.5 * 0.9494 * 2.0 * real::pi * sigma * sigma;
        const double variance = footprint_variance * sigma * sigma + filter_px * filter_px;
        EXPECT_NEAR(sum, flux, 0.002 * flux) << sigma;
        EXPECT_NEAR(x_sum / sum, 0.0, 0.02 * sigma) << sigma;
        EXPECT_NEAR(y_sum / sum, 0.0, 0.02 * sigma) << sigma;
        EXPECT_NEAR(squares / sum / 2.0, variance, 0.05 * variance) << sigma;
    }
}

// Of green; the other channels are right.
Fraction fraction_of(float ratio) {
    Fraction fraction{make_image(width, height, 3, 0.3f), make_image(width, height, 3, 0.3f)};
    for (std::size_t i = 1; i < fraction.wanted.pixels.size(); i += 3)
        fraction.wanted.pixels[i] = 0.3f * ratio;
    return fraction;
}

TEST(FlatLight, AnEvenRatioCorrectsAllThatShines) {
    const PictureSplats before = some_dots();
    const auto corrected = [&](float ratio, bool overshoot) {
        PictureSplats dots = before;
        FlatLight(dots, width, height, filter_px).correct(fraction_of(ratio), overshoot);
        return dots.splats.color;
    };
    const auto plain = corrected(1.5f, false), over = corrected(1.5f, true), most = corrected(2.5f, true);
    for (std::size_t i = 0; i + 1 < plain.size(); ++i) {
        ASSERT_NEAR(plain[i].y, 0.75f, 1e-5f);
        ASSERT_NEAR(over[i].y, 1.125f, 1e-5f);
        ASSERT_NEAR(most[i].y, 1.5f, 1e-5f);
        ASSERT_NEAR(plain[i].x, 1.0f, 1e-6f);
        ASSERT_NEAR(plain[i].z, before.splats.color[i].z, 1e-6f);
    }
    EXPECT_EQ(plain.back(), glm::vec3(-1.0f));  // dust
}

// Detail that only fine splats can show is left to them.
TEST(FlatLight, FineDotsAreSharpened) {
    Fraction fraction = fraction_of(1.0f);
    fraction.wanted.at(48, 32)[1] = 0.45f;
    const auto factor = [&](float sigma, bool overshoot) {
        PictureSplats dots = one_dot(0.5f, -0.5f, sigma);
        FlatLight(dots, width, height, filter_px).correct(fraction, overshoot);
        return dots.splats.color[0].y / 2.0f;
    };
    const float fine = factor(0.5f, false), coarse = factor(4.0f, false);
    EXPECT_GT(fine, 1.2f);
    EXPECT_LT(coarse, 1.1f);
    EXPECT_GT(factor(0.5f, true), 1.1f * fine * fine);
    EXPECT_NEAR(factor(4.0f, true), coarse * coarse, 1e-5f);
}

// A view of their own would take as long as that of many.
TEST(FlatLight, FewDotsSeeWhatTheNextNarrowerOnesDo) {
    Fraction fraction = fraction_of(1.0f);
    fraction.wanted.at(48, 32)[1] = 0.45f;
    // Of a dot of the first size and one of the second, at the same place.
    const auto factors = [&](float second_sigma, int of_second_size) {
        PictureSplats dots = one_dot(0.5f, -0.5f, 0.5f);
        for (int i = 0; i < of_second_size; ++i) {
            dots.splats.position.emplace_back(0.5f, -0.5f, 0.0f);
            dots.splats.color.emplace_back(0.0f, 2.0f, 0.0f);
            dots.splats.alpha.push_back(0.25f);
            dots.splats.radius.push_back(radius_sigmas * second_sigma);
        }
        dots.ranges.push_back({1, dots.splats.size(), second_sigma});
        FlatLight(dots, width, height, filter_px).correct(fraction, true);
        return std::pair(dots.splats.color[0].y, dots.splats.color.back().y);
    };
    const auto [narrow, few] = factors(0.8f, 61);
    EXPECT_EQ(few, narrow);
    const auto [narrow_again, many] = factors(0.8f, 62);
    EXPECT_EQ(narrow_again, narrow);
    EXPECT_LT(many, 0.98f * narrow);
    const auto [as_narrow, coarse] = factors(4.0f, 1);  // is not sharpened
    EXPECT_EQ(as_narrow, narrow);
    EXPECT_LT(coarse, 0.9f * narrow);
}

TEST(FlatLight, MultipliesByAGridsValues) {
    PictureSplats dots = one_dot(0.0f, 0.0f, 1.0f);  // in the middle of the picture: between cells
    Image cells = make_image(3, 2, 3, 1.0f);
    cells.at(1, 0)[1] = 2.0f;
    cells.at(1, 1)[1] = 4.0f;
    FlatLight(dots, width, height, filter_px).multiply(cells, 32.0);
    EXPECT_NEAR(dots.splats.color[0].y, 6.0f, 1e-5f);
}

}  // namespace
}  // namespace astrosplat
