// Measures of the views from the side: drawn points and disks whose shape is known, and the numbers of the
// measures that targets were set with (see front_test.cpp).
#include <gtest/gtest.h>

#include <cmath>

#include "drawn.h"
#include "fidelity/side.h"

namespace astrosplat {
namespace {

// 60 points on a grid, the i-th as large as sigma(i) from left to right and from top to bottom.
template <class Sigma>
Image points(const Sigma& sigma) {
    return drawn(400, 300, [&](std::int64_t x, std::int64_t y, int) {
        double value = 0.0;
        for (int i = 0; i < 60; ++i) {
            const auto [sx, sy] = sigma(i);
            const double dx = (static_cast<double>(x) - (30 + 36 * (i % 10))) / sx;
            const double dy = (static_cast<double>(y) - (30 + 46 * (i / 10))) / sy;
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
            const double dx = static_cast<double>(x % 50 - 25), dy = static_cast<double>(y % 60 - 30) + above;
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
        const auto dx = static_cast<double>(x % 32 - 16), dy = static_cast<double>(y % 24 - 12);
        return std::exp(-0.5 * (dx * dx + dy * dy) / 1.44);
    });
    EXPECT_EQ(needles(crowded).points, 400);
    EXPECT_EQ(needles(make_image(1280, 720, 3)).points, 0);
    EXPECT_EQ(needles(make_image(20, 20, 3, 0.5f)).share, 0.0);
}

TEST(Needles, AreTheNumberOfTheMeasuresThatTargetsWereSetWith) {
    const Image image = drawn(400, 300, [](std::int64_t x, std::int64_t y, int c) {
        double value = 0.02 + 0.0001 * static_cast<double>(x);
        for (int i = 0; i < 60; ++i) {
            const double px = 30 + 36 * (i % 10) + 0.3 * (i % 3), py = 30 + 46 * (i / 10) + 0.25 * (i % 4);
            const double dx = (static_cast<double>(x) - px) / 1.5,
                         dy = (static_cast<double>(y) - py) / (1.5 * (1.0 + 0.3 * (i % 7)));
            value += (0.2 + 0.01 * i) * std::exp(-0.5 * (dx * dx + dy * dy));
        }
        return value * (c == 0 ? 1.0 : c == 1 ? 0.8 : 0.6);
    });
    const Needles found = needles(image);
    EXPECT_EQ(found.points, 60);
    EXPECT_NEAR(found.share, 34.0 / 60.0, 1e-9);
}

// A disk of 400 px, sech^2 of `height` px from top to bottom, fading outward, with a lane of a depth.
Image disk(double height, double fall_px, double lane) {
    return drawn(640, 200, [&](std::int64_t x, std::int64_t y, int) {
        const double r = std::fabs(static_cast<double>(x) - 319.5),
                     z = (static_cast<double>(y) - 99.5) / height;
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
        const double X = static_cast<double>(x) - 319.5, z = static_cast<double>(y) - 99.5;
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

}  // namespace
}  // namespace astrosplat
