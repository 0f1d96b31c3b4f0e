// A painted picture is found again after it was moved, turned and scaled by known amounts.
#include "prepare/registration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/shared_maths.h"

namespace astrosplat {
namespace {

/// Clouds of light at fixed places about (0, 0), reach about 1.5: no two parts are alike.
double clouds(double x, double y) {
    struct Cloud {
        double x, y, radius, light;
    };
    constexpr Cloud all[] = {{0.0, 0.0, 0.25, 0.7},   {0.5, 0.1, 0.12, 0.5},   {-0.3, 0.45, 0.2, 0.4},
                             {-0.6, -0.2, 0.08, 0.8}, {0.2, -0.55, 0.15, 0.5}, {0.8, 0.6, 0.1, 0.6},
                             {-0.9, 0.5, 0.12, 0.5},  {0.75, -0.5, 0.06, 0.9}, {-0.5, -0.75, 0.1, 0.4}};
    double light = 0.02;
    for (const Cloud& c : all)
        light += c.light *
                 real::exp(-((x - c.x) * (x - c.x) + (y - c.y) * (y - c.y)) / (2.0 * c.radius * c.radius));
    return light;
}

/// The clouds on width x height px: `place` says where a picture of 2 x 2 units, 200 px a side, lies.
Image clouds_on(std::int64_t width, std::int64_t height, const PictureOnPicture& place) {
    Image image = make_image(width, height, 1);
    const double angle = real::radians(place.turn_deg), c = real::cos(angle), s = real::sin(angle);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const double dx = (double(x) + 0.5 - place.middle.x) / place.scale / 100.0;
            const double dy = (double(y) + 0.5 - place.middle.y) / place.scale / 100.0;
            *image.at(x, y) = static_cast<float>(clouds(c * dx - s * dy, s * dx + c * dy));
        }
    return image;
}

const Image cloud_picture = clouds_on(200, 200, {{100.0, 100.0}, 1.0, 0.0});

void expect_found(const Image& fixed, const Image& moving, const PictureOnPicture& place,
                  const PictureOnPicture& start) {
    const std::optional<Registration> found = registered(fixed, moving, start);
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(found->place.middle, place.middle), 1.0);
    EXPECT_NEAR(found->place.scale / place.scale, 1.0, 0.005);
    EXPECT_NEAR(std::remainder(found->place.turn_deg - place.turn_deg, 360.0), 0.0, 0.3);
    EXPECT_GT(found->likeness, 0.9);
}

TEST(Registration, FindsAKnownShiftTurnAndScale) {
    for (const PictureOnPicture& place :
         {PictureOnPicture{{160.0, 120.0}, 1.2, 0.0}, PictureOnPicture{{200.0, 90.0}, 1.0, 35.0},
          PictureOnPicture{{140.0, 150.0}, 0.7, -110.0}, PictureOnPicture{{170.0, 110.0}, 1.7, 178.0}})
        expect_found(clouds_on(320, 240, place), cloud_picture, place, {{160.0, 120.0}, 1.2, 0.0});
}

TEST(Registration, AnotherContrastAndOffsetDoNotMatter) {
    const PictureOnPicture place{{150.0, 110.0}, 1.1, -20.0};
    Image fixed = clouds_on(320, 240, place);
    for (float& value : fixed.pixels) value = 0.2f + 0.4f * value;
    expect_found(fixed, cloud_picture, place, {{160.0, 120.0}, 1.0, 0.0});
}

TEST(Registration, PartOfThePictureIsEnough) {
    const PictureOnPicture place{{60.0, 190.0}, 1.4, 15.0};
    expect_found(clouds_on(320, 240, place), cloud_picture, place, {{160.0, 120.0}, 1.2, 0.0});
}

TEST(Registration, LargerPicturesAreFoundAsWell) {
    const PictureOnPicture place{{800.0, 500.0}, 4.0, 50.0};
    expect_found(clouds_on(1600, 1000, place), cloud_picture, place, {{800.0, 500.0}, 5.0, 0.0});
}

TEST(Registration, WhatLiesRightStays) {
    const PictureOnPicture place{{123.25, 130.5}, 1.0, 12.0};
    expect_found(clouds_on(320, 240, place), cloud_picture, place, place);
}

/// Any turn shows the same, which must not keep the shift and the scale from being found.
TEST(Registration, SomethingRoundIsFoundWithAnyTurn) {
    const auto blob = [](std::int64_t width, std::int64_t height, glm::dvec2 middle, double radius) {
        Image image = make_image(width, height, 1);
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) {
                const double r = glm::distance(glm::dvec2(double(x) + 0.5, double(y) + 0.5), middle) / radius;
                *image.at(x, y) = static_cast<float>(real::exp(-r * r) * (1.0 + 0.5 * real::cos(6.0 * r)));
            }
        return image;
    };
    const auto found = registered(blob(320, 240, {170.0, 110.0}, 40.0), blob(200, 200, {100.0, 100.0}, 40.0),
                                  {{160.0, 120.0}, 1.0, 33.0});
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(found->place.middle, glm::dvec2(170.0, 110.0)), 1.0);
    EXPECT_NEAR(found->place.scale, 1.0, 0.005);
}

Image noise(std::int64_t width, std::int64_t height, std::uint32_t seed) {
    Image image = make_image(width, height, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] =
            static_cast<float>(shared::as_hash(seed, static_cast<std::uint32_t>(i), 0u, 1u)) / 4294967296.0f;
    return image;
}

TEST(Registration, WhereNothingMatchesThereIsNone) {
    const PictureOnPicture start{{160.0, 120.0}, 1.0, 0.0};
    EXPECT_FALSE(registered(make_image(320, 240, 1), cloud_picture, start)) << "flat";
    EXPECT_FALSE(registered(clouds_on(320, 240, start), make_image(200, 200, 1, 0.5f), start)) << "flat";
    EXPECT_FALSE(registered(noise(320, 240, 1), noise(200, 200, 2), start));
    EXPECT_FALSE(registered(noise(320, 240, 1), cloud_picture, start));
}

}  // namespace
}  // namespace astrosplat
