// Masks by closed form: areas of ellipses, ranges of luminance, wedges of hue, and how they combine.
#include "source/derived_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/color.h"
#include "core/error.h"
#include "core/real.h"
#include "support/errors.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

constexpr int side = 200;  // px

Image grey(std::int64_t width, std::int64_t height, float value = 0.5f) {
    return make_image(width, height, 4, value);
}

// One row whose pixel i is displayed as `color(i)`, 0..1 a channel.
template <class Color>
Image row_of(int width, const Color& color) {
    Image row = make_image(width, 1, 4, 1.0f);
    for (int x = 0; x < width; ++x) {
        const glm::dvec3 c = color(x);
        for (int k = 0; k < 3; ++k) row.at(x, 0)[k] = static_cast<float>(real::srgb_to_linear(c[k]));
    }
    return row;
}

glm::dvec3 hue_color(double degrees) {
    const auto channel = [&](double peak) {
        const double off = std::fabs(std::remainder(degrees - peak, 360.0));
        return std::clamp(2.0 - off / 60.0, 0.0, 1.0);
    };
    return {channel(0.0), channel(120.0), channel(240.0)};
}

double sum(const Image& weights) {
    double total = 0.0;
    for (const float w : weights.pixels) total += static_cast<double>(w);
    return total;
}

MaskParams ellipse_mask(const glm::dvec4& ellipse, double feather = 0.0, double turn = 0.0) {
    MaskParams mask;
    mask.ellipse = ellipse;
    mask.feather = feather;
    mask.turn = turn;
    return mask;
}

TEST(Mask, NoMaskAndAMaskWithoutTermsShowEverything) {
    EXPECT_EQ(sum(mask_weights(grey(3, 2), {})), 6.0);
    EXPECT_EQ(sum(mask_weights(grey(3, 2), std::vector<MaskParams>(2))), 6.0);
}

TEST(Mask, CircleAndEllipseHaveTheirArea) {
    const double a = 0.25 * side, b = 0.1 * side;
    const auto area = [](const MaskParams& mask) {
        return sum(mask_weights(grey(side, side), std::vector{mask}));
    };
    EXPECT_NEAR(area(ellipse_mask({0.5, 0.5, 0.25, 0.25})), real::pi * a * a, 0.005 * real::pi * a * a);
    EXPECT_NEAR(area(ellipse_mask({0.45, 0.52, 0.25, 0.1}, 0.0, 33.0)), real::pi * a * b,
                0.005 * real::pi * a * b);
    // A linear ramp of width f about radius a holds pi (a^2 + f^2 / 12).
    const double f = 0.3 * side;
    const double soft = real::pi * (a * a + f * f / 12.0);
    EXPECT_NEAR(area(ellipse_mask({0.5, 0.5, 0.25, 0.25}, 0.3)), soft, 0.001 * soft);
}

TEST(Mask, EllipsesLieInPictureWidthsFromTheBottomLeftAndTurnCounterClockwise) {
    const Image light = grey(100, 50);
    const auto weights = [&](const glm::dvec4& ellipse, double turn) {
        return mask_weights(light, std::vector{ellipse_mask(ellipse, 0.0, turn)});
    };
    const Image circle = weights({0.25, 0.8, 0.08, 0.08}, 0.0);  // centre at (25, 10) px from the top
    EXPECT_EQ(*circle.at(25, 3), 1.0f);
    EXPECT_EQ(*circle.at(25, 16), 1.0f);
    EXPECT_EQ(*circle.at(25, 19), 0.0f);
    EXPECT_EQ(*circle.at(18, 10), 1.0f);
    EXPECT_EQ(*circle.at(16, 10), 0.0f);
    const Image turned = weights({0.5, 0.5, 0.2, 0.02}, 45.0);  // up to the right
    EXPECT_EQ(*turned.at(60, 14), 1.0f);
    EXPECT_EQ(*turned.at(60, 35), 0.0f);
}

TEST(Mask, LuminanceIsARampAboutItsEndsAndOpenAtZeroAndOne) {
    constexpr int width = 101;
    const Image row = row_of(width, [](int x) { return glm::dvec3(x / 100.0); });
    MaskParams mask;
    mask.luminance = {0.25, 0.75};
    mask.feather = 0.1;
    const Image weights = mask_weights(row, std::vector{mask});
    for (int x = 0; x < width; ++x) {
        const double up = std::clamp(0.5 + (x / 100.0 - 0.25) / 0.1, 0.0, 1.0);
        const double down = std::clamp(0.5 + (0.75 - x / 100.0) / 0.1, 0.0, 1.0);
        EXPECT_NEAR(*weights.at(x, 0), up * down, 1e-4) << x;
    }
    mask.luminance = {0.0, 0.5};
    EXPECT_EQ(*mask_weights(row, std::vector{mask}).at(0, 0), 1.0f);
    mask.luminance = {0.5, 1.0};
    EXPECT_EQ(*mask_weights(grey(1, 1, 7.0f), std::vector{mask}).at(0, 0), 1.0f);
}

TEST(Mask, HuesAreAWedgeThatMayPassRed) {
    const Image row = row_of(360, [](int x) { return hue_color(x); });
    MaskParams mask;
    mask.hue = {330.0, 30.0};
    const Image wedge = mask_weights(row, std::vector{mask});
    for (int x = 0; x < 360; ++x) {
        if (x % 30 == 0) continue;  // on the border
        EXPECT_EQ(*wedge.at(x, 0), x < 30 || x > 330 ? 1.0f : 0.0f) << x;
    }
    mask.hue = {100.0, 140.0};
    mask.feather = 10.0 / 360.0;
    const Image soft = mask_weights(row, std::vector{mask});
    for (int x = 0; x < 360; ++x)
        EXPECT_NEAR(*soft.at(x, 0), std::clamp(0.5 + (20.0 - std::abs(x - 120)) / 10.0, 0.0, 1.0), 2e-3) << x;
    EXPECT_EQ(sum(mask_weights(grey(4, 4), std::vector{mask})), 0.0) << "grey has no hue";
    mask.hue = {0.0, 360.0};
    EXPECT_EQ(sum(mask_weights(row, std::vector{mask})), 360.0);
}

TEST(Mask, SaturationIsThatOfTheDisplayedColor) {
    const Image row = row_of(101, [](int x) { return glm::dvec3(0.8, 0.8 * (1.0 - x / 100.0), 0.8); });
    MaskParams mask;
    mask.saturation = {0.4, 1.0};
    const Image weights = mask_weights(row, std::vector{mask});
    EXPECT_EQ(*weights.at(39, 0), 0.0f);
    EXPECT_EQ(*weights.at(41, 0), 1.0f);
    EXPECT_EQ(*weights.at(100, 0), 1.0f);
}

TEST(Mask, ListsMultiplyAlternativesTakeTheLargestInvertTurnsOver) {
    const Image light = grey(100, 100);
    const MaskParams left = ellipse_mask({0.35, 0.5, 0.2, 0.2}), right = ellipse_mask({0.65, 0.5, 0.2, 0.2});
    const double one = sum(mask_weights(light, std::vector{left}));
    const double both = sum(mask_weights(light, std::vector{left, right}));
    // Two circles of radius r at a distance d share 2 r^2 acos(d / 2r) - d/2 sqrt(4 r^2 - d^2).
    const double r = 20.0, d = 30.0;
    EXPECT_NEAR(both, 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d), 5.0);
    MaskParams either;
    either.any = {left, right};
    EXPECT_EQ(sum(mask_weights(light, std::vector{either})), 2 * one - both);
    either.invert = true;
    EXPECT_EQ(sum(mask_weights(light, std::vector{either})), 1e4 - (2 * one - both));
    either.invert = false;
    either.any[0].invert = true;
    EXPECT_EQ(sum(mask_weights(light, std::vector{either})), 1e4 - one + both);
}

TEST(Mask, AnImageCoversTheTextureWhateverItsSize) {
    const TempFolder folder;
    MaskParams mask;
    mask.image = folder.file("half.pgm", "P2 2 2 255\n255 0\n255 0\n");
    const Image weights = mask_weights(grey(80, 30), std::vector{mask});
    EXPECT_EQ(*weights.at(0, 10), 1.0f);
    EXPECT_EQ(*weights.at(79, 10), 0.0f);
    EXPECT_NEAR(sum(weights), 0.5 * 80 * 30, 1e-3);
    mask.image = folder / "none.pgm";
    EXPECT_NE(message_of<InputError>([&] { mask_weights(grey(2, 2), std::vector{mask}); }).find("none.pgm"),
              std::string::npos);
}

TEST(Mask, AMapWeighsByItsValueOrByTheRangeOfLuminance) {
    Image light = grey(64, 64, 0.2f);  // grey, and one pixel that is redder by half of its red
    light.at(20, 30)[0] = 0.4f;
    MaskParams mask;
    mask.derive = Derived::h_alpha;
    EXPECT_NEAR(sum(mask_weights(light, std::vector{mask})), 0.2 / 0.402, 1e-6);
    mask.luminance = {0.3, 1.0};
    EXPECT_EQ(sum(mask_weights(light, std::vector{mask})), 1.0);
    mask.luminance = {0.6, 1.0};
    EXPECT_EQ(sum(mask_weights(light, std::vector{mask})), 0.0);
}

}  // namespace
}  // namespace astrosplat
