// Measures of pictures: colours, a front view, views from the side.
#include <glm/vec4.hpp>

#include "core/color.h"
#include "core/image.h"
#include "fidelity/display.h"
#include "fidelity/front.h"
#include "fidelity/side.h"
#include "image/resample.h"
#include "support/test.h"

namespace astrosplat {
namespace {

/// color(x, y, channel) at every pixel.
template <class Color>
Image drawn(std::int64_t width, std::int64_t height, const Color& color) {
    Image image = make_image(width, height, 3);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(color(x, y, c));
    return image;
}

/// Waves and 25 stars on 240 x 160 units, at a place in units.
double waves_and_stars(double x, double y, int c) {
    double value = 0.05 + 0.12 * (1.0 + std::sin(0.11 * x + c) * std::cos(0.07 * y - c));
    for (int k = 0; k < 25; ++k) {
        const double dx = x - (13 + (k * 97) % 214), dy = y - (11 + (k * 61) % 138),
                     sigma = 1.2 + 0.2 * (k % 4);
        const double share = c == 0 ? 1.0 : c == 1 ? 0.9 : 0.7 + 0.1 * (k % 3);
        value += share * (0.1 + 0.03 * (k % 9)) * std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
    }
    return value;
}

/// The same as a picture of 240 x 160 px times `scale`.
Image waves_and_stars(int scale) {
    return drawn(240 * scale, 160 * scale, [&](std::int64_t x, std::int64_t y, int c) {
        return waves_and_stars((double(x) + 0.5) / scale, (double(y) + 0.5) / scale, c);
    });
}

/// As a renderer might show it: rippled by 5 % and with a little noise.
Image rendered_waves_and_stars() {
    return drawn(240, 160, [&](std::int64_t x, std::int64_t y, int c) {
        const auto i = double(x), j = double(y);
        const double noise = double((x * 7919 + y * 104729 + c * 1299709) % 1000) / 1000.0 - 0.5;
        return waves_and_stars(i + 0.5, j + 0.5, c) * (1.0 + 0.05 * std::sin(0.9 * i + 1.3 * j)) +
               0.01 * noise;
    });
}

// Measures of a front view against closed forms, and against the measures that the targets were set with:
// numbers of an independent program in double precision (numpy and scipy) for the same drawn pictures.

Image times(Image image, float r, float g, float b) {
    for (std::int64_t i = 0; i < image.width * image.height; ++i) {
        float* const p = image.pixels.data() + i * image.channels;
        p[0] *= r, p[1] *= g, p[2] *= b;
    }
    return image;
}

// Displayed values a and b everywhere.
double psnr_of_flat(double a, double b) {
    const auto flat = [](double displayed) {
        return make_image(40, 30, 3, float(real::srgb_to_linear(displayed)));
    };
    return psnr_db(flat(a), flat(b));
}

TEST(Psnr, OfAKnownError) {
    EXPECT_NEAR(psnr_of_flat(0.5, 0.6), 20.0, 1e-4);
    EXPECT_NEAR(psnr_of_flat(0.30, 0.31), 40.0, 1e-3);
    EXPECT_NEAR(psnr_of_flat(0.3, 0.3), 120.0, 1e-9);
    EXPECT_NEAR(psnr_of_flat(0.9, 1.7), 20.0, 1e-4) << "what is displayed ends at white";
}

TEST(Ssim, OfItselfIsOneAndOfFlatPicturesItsFormula) {
    const Image image = waves_and_stars(1);
    EXPECT_NEAR(ssim(image, image), 1.0, 1e-12);
    const Image dark = make_image(30, 20, 3, float(real::srgb_to_linear(0.2)));
    const Image light = make_image(30, 20, 3, float(real::srgb_to_linear(0.6)));
    EXPECT_NEAR(ssim(dark, light), (2 * 0.2 * 0.6 + 1e-4) / (0.04 + 0.36 + 1e-4), 1e-4);
}

// Floats instead of doubles move the displayed values by 1e-7, a sixtieth of a thousandth of
// the error measured.
TEST(FrontFidelity, IsTheNumbersOfTheMeasuresThatTargetsWereSetWith) {
    const Image picture = waves_and_stars(2), seen = rendered_waves_and_stars();
    const Image reference = resampled(picture, map_to_width(picture, 240, 160), 240, 160, 0.5);
    const FrontFidelity front = front_fidelity(seen, reference);
    EXPECT_NEAR(front.psnr_db, 41.407099483, 1e-3);
    EXPECT_NEAR(front.ssim, 0.953323037, 1e-4);
    EXPECT_NEAR(front.flux.frame, 0.9999702084, 1e-6);
    EXPECT_EQ(front.width_px, 240);
    EXPECT_EQ(front.height_px, 160);
}

TEST(FrontFidelity, LeavesTheBorderOut) {
    const Image a = waves_and_stars(1);
    Image b = a;
    for (std::int64_t y = 0; y < b.height; ++y)
        for (std::int64_t x = 0; x < b.width; ++x)
            if (x < 24 || y < 24 || x >= b.width - 24 || y >= b.height - 24) b.at(x, y)[1] = 0.0f;
    EXPECT_LT(front_fidelity(b, a).psnr_db, 20.0);
    EXPECT_LT(front_fidelity(b, a, 0.09).psnr_db, 50.0);
    EXPECT_EQ(front_fidelity(b, a, 0.1).psnr_db, psnr_db(a, a));
}

TEST(Flux, OfAScaledPictureIsTheScale) {
    const Image picture = waves_and_stars(1);
    const FluxRatios flux = flux_ratios(times(picture, 1.25f, 1.0f, 0.5f), picture);
    EXPECT_NEAR(flux.channels[0], 1.25, 1e-6);
    EXPECT_NEAR(flux.channels[1], 1.0, 1e-6);
    EXPECT_NEAR(flux.channels[2], 0.5, 1e-6);
    const FluxRatios even = flux_ratios(times(picture, 1.1f, 1.1f, 1.1f), picture);
    for (const double cell : even.cells) EXPECT_NEAR(cell, 1.1, 1e-6);
    for (const double p : {even.frame, even.cells_5, even.cells_50, even.cells_95}) EXPECT_NEAR(p, 1.1, 1e-6);
}

TEST(Flux, ThePercentilesAreThoseOfTheCells) {
    const Image reference = make_image(320, 320, 3, 0.5f);
    Image seen = reference;  // the columns of cells hold 1.00, 1.01 ... 1.31 of the light
    for (std::int64_t y = 0; y < 320; ++y)
        for (std::int64_t x = 0; x < 320; ++x) seen.at(x, y)[1] *= 1.0f + 0.03f * float(x / 10);
    const FluxRatios flux = flux_ratios(seen, reference);
    EXPECT_NEAR(flux.cells_5, 1.01, 1e-5);
    EXPECT_NEAR(flux.cells_50, 1.155, 1e-5);
    EXPECT_NEAR(flux.cells_95, 1.30, 1e-5);
}

TEST(Flux, ACellIsAPlaceAndADarkOneCountsForNothing) {
    Image reference = make_image(64, 96, 3, 0.5f), seen = reference;  // cells of 2 x 3 px
    const auto set_cell = [](Image& image, std::int64_t column, std::int64_t row, float value) {
        for (std::int64_t y = 3 * row; y < 3 * row + 3; ++y)
            for (std::int64_t x = 2 * column; x < 2 * column + 2; ++x) std::fill_n(image.at(x, y), 3, value);
    };
    set_cell(seen, 5, 7, 1.0f);
    set_cell(reference, 31, 0, 0.001f);
    const FluxRatios flux = flux_ratios(seen, reference);
    for (std::size_t i = 0; i < flux.cells.size(); ++i) {
        if (i == 31)
            EXPECT_TRUE(std::isnan(flux.cells[i]));
        else
            EXPECT_NEAR(flux.cells[i], i == 7 * 32 + 5 ? 2.0 : 1.0, 1e-9) << i;
    }
    EXPECT_TRUE(std::isnan(flux_ratios(seen, make_image(64, 96, 3)).frame));
}

TEST(ScalePower, OfAScaledWaveIsTheSquareInItsBandAlone) {
    // Waves of displayed values about one half, of periods 8 and 64 px; the short one is drawn at 60 %.
    const auto wave = [](double share) {
        return drawn(256, 256, [&](std::int64_t x, std::int64_t, int) {
            const double phase = 2.0 * 3.14159265358979 * double(x);
            return real::srgb_to_linear(0.5 + 0.1 * share * std::sin(phase / 8.0) +
                                        0.1 * std::sin(phase / 64.0));
        });
    };
    const std::vector<ScalePower> bands = power_by_scale(wave(0.6), wave(1.0));
    ASSERT_EQ(bands.size(), 6u);  // up to 32 px, an eighth of the side
    EXPECT_EQ(bands[0].finer_px, 0.0);
    EXPECT_EQ(bands[0].coarser_px, 1.0);
    EXPECT_EQ(bands[5].coarser_px, 32.0);
    EXPECT_NEAR(bands[0].ratio, 0.36, 0.01);
    EXPECT_NEAR(bands[1].ratio, 0.36, 0.01);
    EXPECT_NEAR(bands[4].ratio, 1.0, 0.01);
    EXPECT_TRUE(std::isnan(power_by_scale(wave(1.0), make_image(256, 256, 3, 0.2f))[2].ratio));
}

// Measures of the views from the side: drawn points and disks whose shape is known, and the numbers of the
// measures that targets were set with (see front_test.cpp).

// 60 points on a grid, the i-th as large as sigma(i) from left to right and from top to bottom.
template <class Sigma>
Image points(const Sigma& sigma) {
    return drawn(400, 300, [&](std::int64_t x, std::int64_t y, int) {
        double value = 0.0;
        for (int i = 0; i < 60; ++i) {
            const auto [sx, sy] = sigma(i);
            const double dx = (double(x) - (30 + 36 * (i % 10))) / sx;
            const double dy = (double(y) - (30 + 46 * (i / 10))) / sy;
            if (dx * dx + dy * dy < 60.0) value += 0.5 * std::exp(-0.5 * (dx * dx + dy * dy));
        }
        return value;
    });
}

TEST(Needles, RoundPointsAreNone) {
    const Needles found = needles(points([](int i) { return std::pair{1.0 + 0.02 * i, 1.0 + 0.02 * i}; }));
    EXPECT_EQ(found.points, 60);
    EXPECT_EQ(found.share, 0.0);
}

TEST(Needles, OfAFlatPictureAreThoseTwiceAsLongInIt) {
    EXPECT_EQ(flat_needles(points([](int) {
                  return std::pair{1.2, 2.4};
              })).share,
              0.0)
        << "round from 60 degrees";
    const Needles rims = flat_needles(points([](int) { return std::pair{1.2, 6.0}; }));
    EXPECT_EQ(rims.share, 1.0);
    EXPECT_EQ(rims.points, 60);
}

TEST(Needles, AreLongFromTopToBottomAndNotAcross) {
    EXPECT_EQ(needles(points([](int) { return std::pair{1.2, 3.0}; })).share, 1.0);
    EXPECT_EQ(needles(points([](int) { return std::pair{3.0, 1.2}; })).share, 0.0);
    EXPECT_NEAR(needles(points([](int i) { return std::pair{1.2, i % 4 ? 1.2 : 3.0}; })).share, 0.25, 1e-12);
}

TEST(Needles, TwoPointsAboveEachOtherAreNotOne) {
    const Image pairs = drawn(400, 300, [](std::int64_t x, std::int64_t y, int) {
        double value = 0.0;
        for (const double above : {0.0, 8.0}) {
            const double dx = double(x % 50 - 25), dy = double(y % 60 - 30) + above;
            value += 0.5 * std::exp(-0.5 * (dx * dx + dy * dy));
        }
        return value;
    });
    const Needles found = needles(pairs);
    EXPECT_EQ(found.points, 2 * 8 * 5);
    EXPECT_EQ(found.share, 0.0);
}

TEST(Needles, AreCountedAmongTheStrongestAwayFromTheEdges) {
    const Image crowded = drawn(1280, 720, [](std::int64_t x, std::int64_t y, int) {
        const auto dx = double(x % 32 - 16), dy = double(y % 24 - 12);
        return std::exp(-0.5 * (dx * dx + dy * dy) / 1.44);
    });
    EXPECT_EQ(needles(crowded).points, 400);
    EXPECT_EQ(needles(make_image(1280, 720, 3)).points, 0);
    EXPECT_EQ(needles(make_image(20, 20, 3, 0.5f)).share, 0.0);
}

TEST(Needles, AreTheNumberOfTheMeasuresThatTargetsWereSetWith) {
    const Image image = drawn(400, 300, [](std::int64_t x, std::int64_t y, int c) {
        double value = 0.02 + 0.0001 * double(x);
        for (int i = 0; i < 60; ++i) {
            const double px = 30 + 36 * (i % 10) + 0.3 * (i % 3), py = 30 + 46 * (i / 10) + 0.25 * (i % 4);
            const double dx = (double(x) - px) / 1.5, dy = (double(y) - py) / (1.5 * (1.0 + 0.3 * (i % 7)));
            value += (0.2 + 0.01 * i) * std::exp(-0.5 * (dx * dx + dy * dy));
        }
        return value * (c == 0 ? 1.0 : c == 1 ? 0.8 : 0.6);
    });
    const Needles found = needles(image);
    EXPECT_EQ(found.points, 60);
    EXPECT_NEAR(found.share, 34.0 / 60.0, 1e-9);
}

// Waves of all sizes, `more` of one of them, across a band `wide` px wide.
Image waves_in_a_band(double wide, double more) {
    return drawn(400, 300, [&](std::int64_t column, std::int64_t row, int c) {
        const auto x = double(column), y = double(row);
        double value = 0.3 + more * std::sin(x / 6.0 + y / 7.0);
        for (const double length : {1.5, 3.0, 6.0, 12.0, 24.0}) value += 0.02 * std::sin(x / length);
        const double across = (y - 149.5) / wide;
        return value * std::exp(-0.5 * across * across) * (c == 0 ? 1.0 : c == 1 ? 0.8 : 0.6);
    });
}

// The numbers are those of the measures that targets were set with; wide blurs are made at half the size.
TEST(Mottle, IsWhatAViewFromAsideHasAndTheFrontHasNot) {
    const Image front = waves_in_a_band(60.0, 0.0);
    EXPECT_NEAR(mottle(front, waves_in_a_band(42.0, 0.03)), 1.448, 0.02);
    EXPECT_NEAR(mottle(front, front), 1.0, 1e-12);
    EXPECT_EQ(mottle(make_image(64, 64, 3), make_image(64, 64, 3)), 0.0);
}

TEST(DiskFromAbove, IsAsRoundAndAsGrainyAsDrawn) {
    const Image image = drawn(640, 400, [](std::int64_t column, std::int64_t row, int c) {
        const double x = double(column), y = double(row);
        const double u = (x - 319.5) / 120.0, v = (y - 199.5) / 90.0;
        return 0.6 * std::exp(-0.5 * (u * u + v * v)) *
               (1.0 + 0.2 * std::sin(x / 4.0) + 0.1 * std::sin(y / 5.0)) *
               (c == 0   ? 1.0
                : c == 1 ? 0.8
                         : 0.6);
    });
    const DiskFromAbove found = disk_from_above(image);
    EXPECT_NEAR(found.roundness, 0.7528, 0.005);
    EXPECT_NEAR(found.grain, 2.406, 0.06);
    EXPECT_EQ(disk_from_above(make_image(64, 64, 3)).roundness, 0.0);
}

// A disk of 400 px, sech^2 of `height` px from top to bottom, fading outward, with a lane of a depth.
Image disk(double height, double fall_px, double lane) {
    return drawn(640, 200, [&](std::int64_t x, std::int64_t y, int) {
        const double r = std::fabs(double(x) - 319.5), z = (double(y) - 99.5) / height;
        if (r > 200.0) return 0.0;
        const double dust = 1.0 - lane * std::exp(-0.5 * (z * height / 3.0) * (z * height / 3.0));
        return 0.8 * std::exp(-r / fall_px) * dust / (std::cosh(z) * std::cosh(z));
    });
}

TEST(EdgeOn, OfADrawnDisk) {
    const EdgeOnProfile even = edge_on_profile(disk(12.0, 1e9, 0.0));
    const double fwhm = 2.0 * 12.0 * std::acosh(std::sqrt(2.0));  // sech^2
    EXPECT_NEAR(even.fwhm_over_length, fwhm / 400.0, 1.0 / 400.0);
    EXPECT_NEAR(even.dust_dip, 0.0, 0.2) << "the least of the middle half, where there is no lane";
    EXPECT_NEAR(even.center_over_half, 1.0, 1e-3);
    const EdgeOnProfile falling = edge_on_profile(disk(12.0, 80.0, 0.0));
    EXPECT_NEAR(falling.center_over_half, std::exp(75.0 / 80.0), 0.15)
        << "the disk ends at 15 %, 152 px from the middle";
}

TEST(EdgeOn, TheLaneIsAsDeepAsDrawn) {
    for (const double lane : {0.4, 0.55, 0.7}) {
        // The lane's Gaussian of 3 px is seen through one of 0.8 px: wider, and shallower by as much.
        const double sigma = std::sqrt(9.0 + 0.64);
        const auto light = [&](double z) {
            const double cosh = std::cosh(z / 12.0);
            return (1.0 - lane * (3.0 / sigma) * std::exp(-0.5 * z * z / (sigma * sigma))) / (cosh * cosh);
        };
        double brightest = 0.0;
        for (int z = 0; z < 20; ++z) brightest = std::max(brightest, light(z + 0.5));
        EXPECT_NEAR(edge_on_profile(disk(12.0, 1e9, lane)).dust_dip, 1.0 - light(0.5) / brightest, 0.005)
            << lane;
    }
}

TEST(EdgeOn, IsTheNumbersOfTheMeasuresThatTargetsWereSetWith) {
    const Image image = drawn(640, 200, [](std::int64_t x, std::int64_t y, int c) {
        const double X = double(x) - 319.5, z = double(y) - 99.5;
        const double height = 9.0 + 3.0 * std::exp(-X * X / (2.0 * 40.0 * 40.0));
        const double lane =
            1.0 - 0.55 * std::exp(-0.5 * (z - 1.0) * (z - 1.0) / 4.0) * std::exp(-std::pow(X / 260.0, 4));
        const double light =
            0.9 * std::exp(-std::fabs(X) / 110.0) * lane / std::pow(std::cosh(z / height), 2);
        return light * (c == 0 ? 1.0 : c == 1 ? 0.9 : 0.7);
    });
    const EdgeOnProfile profile = edge_on_profile(image);
    EXPECT_NEAR(profile.fwhm_over_length, 0.05649717514, 1e-9) << "whole pixels";
    EXPECT_NEAR(profile.dust_dip, 0.36226819631, 1e-5);
    EXPECT_NEAR(profile.center_over_half, 2.284096932290, 1e-4);
    EXPECT_NEAR(profile.body_srgb, 0.611853300777, 1e-5);
}

TEST(EdgeOn, OfABlackPictureIsNothing) {
    const EdgeOnProfile none = edge_on_profile(make_image(64, 32, 3));
    EXPECT_EQ(none.fwhm_over_length, 0.0);
    EXPECT_EQ(none.center_over_half, 0.0);
}

// Differences of colours: CIEDE2000, and the picture of a signed difference.

// CIEDE2000 against the published pairs, and L*a*b* of known colours.

// Sharma, Wu, Dalal (2005), table 1: two colours and their difference, to four decimals.
constexpr double published[][7] = {
    {50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425},
    {50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615},
    {50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412},
    {50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669},
    {50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461},
    {50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065},
    {50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492},
    {50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977},
    {50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030},
    {50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
};

TEST(Ciede2000, IsThatOfThePublishedPairs) {
    for (const auto& p : published) {
        const Lab first{p[0], p[1], p[2]}, second{p[3], p[4], p[5]};
        EXPECT_NEAR(ciede2000(first, second), p[6], 5.1e-5) << p[1] << " " << p[2] << " to " << p[4];
        EXPECT_NEAR(ciede2000(second, first), p[6], 5.1e-5) << p[1] << " " << p[2] << " from " << p[4];
    }
}

TEST(Lab, OfKnownColours) {
    const float white[] = {1.0f, 1.0f, 1.0f}, grey[] = {0.18f, 0.18f, 0.18f}, red[] = {1.0f, 0.0f, 0.0f};
    for (const auto& [color, lightness] : {std::pair{white, 100.0}, {grey, 49.496}}) {
        const Lab lab = lab_of_linear(color);
        EXPECT_NEAR(lab.L, lightness, 1e-3);
        EXPECT_NEAR(lab.a, 0.0, 1e-4);
        EXPECT_NEAR(lab.b, 0.0, 1e-4);
    }
    const Lab lab = lab_of_linear(red);
    EXPECT_NEAR(lab.L, 53.24, 0.01);
    EXPECT_NEAR(lab.a, 80.10, 0.01);
    EXPECT_NEAR(lab.b, 67.22, 0.01);
    const float black[] = {0.0f, 0.0f, 0.0f}, faint[] = {0.001f, 0.001f, 0.001f};
    EXPECT_NEAR(lab_of_linear(black).L, 0.0, 1e-12);
    EXPECT_NEAR(lab_of_linear(faint).L, 24389.0 / 27.0 * 0.001, 1e-6) << "the straight part";
    const float beyond[] = {3.0f, -1.0f, 0.0f};
    EXPECT_EQ(lab_of_linear(beyond).L, lab.L) << "clamped to what is displayed";
}

TEST(ColorDifferences, ArePercentilesOverThePixels) {
    const Image dark = make_image(40, 10, 3, 0.2f);
    Image image = dark;
    for (std::int64_t y = 0; y < 10; ++y)
        for (std::int64_t x = 0; x < 4; ++x) std::fill_n(image.at(x, y), 3, 0.4f);
    const ColorDifferences d = color_differences(image, dark);
    EXPECT_EQ(d.median, 0.0);
    EXPECT_EQ(d.percentile_95, ciede2000(lab_of_linear(image.at(0, 0)), lab_of_linear(dark.at(0, 0))));
}

// Larger pictures are looked at here and there: every step-th pixel both ways.
TEST(ColorDifferences, OfALargePictureAreThoseOfASample) {
    const Image a =
        drawn(2100, 1000, [](std::int64_t x, std::int64_t, int) { return 0.2 + 1e-4 * double(x); });
    const Image b =
        drawn(2100, 1000, [](std::int64_t x, std::int64_t, int) { return 0.2 + 2e-4 * double(x); });
    const Image left = drawn(1, 1, [](std::int64_t, std::int64_t, int) { return 0.2 + 0.105; });
    const Image right = drawn(1, 1, [](std::int64_t, std::int64_t, int) { return 0.2 + 0.21; });
    const double middle = ciede2000(lab_of_linear(left.at(0, 0)), lab_of_linear(right.at(0, 0)));
    EXPECT_NEAR(color_differences(a, b).median, middle, 0.01);
}

/// One pixel of linear light whose displayed value is `displayed`.
Image pixel(float displayed) {
    const float linear = float(real::srgb_to_linear(displayed));
    return make_image(1, 1, 3, linear);
}

glm::vec4 shown(float a, float b) {
    const Image image = signed_difference(pixel(a), pixel(b));
    const float* p = image.at(0, 0);
    return {p[0], p[1], p[2], p[3]};
}

TEST(SignedDifference, IsOrangeWhereBrighterAndBlueWhereDarker) {
    const glm::vec4 none = shown(0.5f, 0.5f), more = shown(0.6f, 0.5f), less = shown(0.5f, 0.6f);
    EXPECT_LT(std::max({none.x, none.y, none.z}), 0.1f);
    EXPECT_NEAR(more.x, 1.0f, 1e-3f);
    EXPECT_LT(more.z, 0.2f);
    EXPECT_NEAR(less.z, 1.0f, 1e-3f);
    EXPECT_LT(less.x, 0.3f);
    EXPECT_EQ(none.w, 1.0f);
}

TEST(SignedDifference, GrowsEvenlyUpToFullColour) {
    const glm::vec4 none = shown(0.3f, 0.3f), half = shown(0.35f, 0.3f), full = shown(0.4f, 0.3f);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(half[k], 0.5f * (none[k] + full[k]), 1e-3f);
    EXPECT_EQ(shown(1.0f, 0.0f), shown(0.7f, 0.2f));
}

}  // namespace
}  // namespace astrosplat
