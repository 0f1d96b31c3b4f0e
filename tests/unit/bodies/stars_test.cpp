#include "bodies/stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bodies/picture_light.h"
#include "bodies/picture_stars.h"
#include "detect/knots.h"
#include "image/channels.h"
#include "support/painted_picture.h"

namespace astrosplat {
namespace {

// A sky that is brighter on one side, with a little texture.
Image sky(std::int64_t width, std::int64_t height) {
    Image image = make_image(width, height, 3);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] =
                    0.02f + 0.1f * static_cast<float>(x) / static_cast<float>(width) +
                    0.004f * painted::fbm(static_cast<double>(x), static_cast<double>(y), 0.11, 7u);
    return image;
}

struct Planted {
    double x, y, sigma, light;
};
const std::vector<Planted> planted{{40.3, 30.8, 0.9, 0.3},
                                   {90.0, 80.5, 1.2, 0.8},
                                   {150.6, 40.1, 1.5, 0.5},
                                   {200.2, 90.9, 0.8, 0.25},
                                   {60.7, 100.2, 1.0, 0.6}};

TEST(Stars, AreFoundWhereTheyAreAndTakenOut) {
    const Image before = sky(256, 128);
    Image light = before;
    for (const Planted& p : planted)
        painted::add_point(light, p.x, p.y, p.sigma, p.light, 0.8 * p.light, 0.6 * p.light);
    const std::vector<Star> stars = take_stars(light);
    ASSERT_EQ(stars.size(), planted.size());
    for (const Planted& p : planted) {
        const Star* nearest = &stars.front();
        for (const Star& s : stars)
            if (std::hypot(s.x - p.x, s.y - p.y) < std::hypot(nearest->x - p.x, nearest->y - p.y))
                nearest = &s;
        EXPECT_NEAR(nearest->x, p.x, 0.2);
        EXPECT_NEAR(nearest->y, p.y, 0.2);
        EXPECT_NEAR(nearest->sigma, p.sigma, 0.25 * p.sigma);
        EXPECT_NEAR(nearest->peak.x, p.light, 0.25 * p.light);
        EXPECT_GT(nearest->peak.x, nearest->peak.z);
    }
    for (std::size_t i = 0; i < light.pixels.size(); ++i)  // what wings are cut to
        ASSERT_NEAR(light.pixels[i], before.pixels[i], 0.016f + 0.15f * before.pixels[i])
            << "pixel " << i / 3;
}

TEST(Stars, KnotsAndEdgesAreNone) {
    Image light = sky(256, 128);
    painted::add_point(light, 80.0, 60.0, 4.0, 0.5, 0.5, 0.5);  // wider than a star
    for (int i = 0; i < 40; ++i) painted::add_point(light, 150.0 + i, 50.0, 0.9, 0.2, 0.2, 0.2);  // a thread
    const Image before = light;
    EXPECT_TRUE(take_stars(light).empty());
    for (std::size_t i = 0; i < light.pixels.size(); ++i) ASSERT_EQ(light.pixels[i], before.pixels[i]);
}

// A flat top is narrower than the Gaussian of its peak and light: the ring around would be a hole, and so
// dust.
TEST(Stars, FlatOnesLeaveNoHole) {
    Image light = make_image(128, 96, 3, 0.05f);
    painted::add_point(light, 60.4, 50.3, 0.9, 1.6, 1.6, 1.6);
    for (float& value : light.pixels) value = std::min(value, 1.0f);
    ASSERT_EQ(take_stars(light).size(), 1u);
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
        ASSERT_GE(light.pixels[i], 0.044f) << "pixel " << i / 3;
}

// Left in, each of them would be a row of faint dots in depth.
TEST(Stars, FaintOnesInADarkSkyAreTaken) {
    Image light = make_image(256, 128, 3, 0.006f);
    for (std::uint32_t i = 0; i < 20; ++i)
        painted::add_point(light, 20.0 + 11.3 * i, 30.0 + 61.0 * painted::random(i, 1), 0.9, 0.025, 0.02,
                           0.02);
    EXPECT_EQ(take_stars(light).size(), 20u);
}

// The narrowest Gaussian of a single pixel has most of its light beside it, where the picture has none.
TEST(Stars, OfEnlargedPicturesAreOnlyWhatHasTheLightOfOne) {
    Image light = sky(256, 128);
    for (const Planted& p : planted)
        painted::add_point(light, p.x, p.y, p.sigma, p.light, 0.8 * p.light, 0.6 * p.light);
    for (int c = 0; c < 3; ++c) light.at(120, 30)[c] += 0.5f;
    StructureParams params;
    params.kind = StructureKind::sheet;
    Image whole = light, enlarged = light;
    EXPECT_EQ(take_picture_stars(whole, params).all.size(), planted.size() + 1);
    EXPECT_EQ(take_picture_stars(enlarged, params, true).all.size(), planted.size());
    EXPECT_EQ(enlarged.at(120, 30)[0], light.at(120, 30)[0]);
}

TEST(Knots, OwnThePixelsAroundThem) {
    Image light = sky(256, 128);
    painted::add_point(light, 80.0, 60.0, 3.0, 0.5, 0.5, 0.5);
    const Image brightest = brightest_channel(light);
    const Knots knots = find_knots(brightest);
    ASSERT_EQ(knots.knots.size(), 1u);
    EXPECT_NEAR(knots.knots[0].x, 80.0, 1.0);
    EXPECT_NEAR(knots.knots[0].y, 60.0, 1.0);
    EXPECT_GT(knots.knots[0].sigma, 2.0f);
    EXPECT_LT(knots.knots[0].sigma, 5.0f);
    const auto at = [&](std::int64_t x, std::int64_t y) { return static_cast<std::size_t>(y * 256 + x); };
    EXPECT_EQ(knots.owner[at(80, 60)], 0);
    EXPECT_EQ(knots.weight[at(80, 60)], 1.0f);
    const auto rim = static_cast<std::int64_t>(80.0f + 2.6f * knots.knots[0].sigma);
    EXPECT_GT(knots.weight[at(rim, 60)], 0.0f);
    EXPECT_LT(knots.weight[at(rim, 60)], 0.6f);
    EXPECT_EQ(knots.owner[at(200, 100)], -1);
}

TEST(Knots, ThoseOfAFilamentAreNotRound) {
    Image light = make_image(320, 200, 3, 0.05f);
    painted::add_point(light, 60.0, 100.0, 3.0, 0.5, 0.5, 0.5);
    for (int i = 0; i < 60; ++i)  // slanted, with bright places
        painted::add_point(light, 130.0 + 2.0 * i, 40.0 + 1.5 * i, 2.5, 0.10 + 0.006 * (i % 10 == 5), 0.1,
                           0.1);
    const Knots found = find_knots(brightest_channel(light));
    int along = 0;
    for (const Knot& knot : found.knots) {
        if (knot.x < 100.0f) {
            EXPECT_GT(knot.roundness, 0.95f);
        } else if (knot.x > 145.0f && knot.x < 235.0f) {
            EXPECT_LT(knot.roundness, 0.3f) << knot.x << ", " << knot.y;
            ++along;
        }
    }
    EXPECT_GE(along, 3);
}

// A star of one pixel is narrower than its Gaussian. Where there is dust, the hole around it would become
// some.
TEST(Stars, LeaveNoHolesInDisksAndNoLightInClouds) {
    for (const StructureKind kind : {StructureKind::disk, StructureKind::sheet, StructureKind::walls}) {
        Image light = make_image(64, 48, 3, 0.05f);
        for (int c = 0; c < 3; ++c) light.at(30, 20)[c] = 0.6f;
        StructureParams params;
        params.kind = kind;
        ASSERT_EQ(take_picture_stars(light, params).count, 1);
        if (kind == StructureKind::disk)
            EXPECT_NEAR(light.at(31, 20)[0], least_left_in_dust * 0.05f, 1e-6f);
        else
            EXPECT_EQ(light.at(31, 20)[0], 0.0f);
    }
}

// The fit takes the dots of a range for as wide as each other.
TEST(Stars, ThoseOfARangeAreAboutOfOneSize) {
    Image image = sky(512, 256);
    for (int i = 0; i < 28; ++i)
        painted::add_point(image, 40.3 + 32.0 * (i % 14), 60.7 + 100.0 * (i / 14), 0.7 + 0.05 * i, 0.5, 0.5,
                           0.5);
    StructureParams params;
    params.kind = StructureKind::sheet;
    const PictureStars stars = take_picture_stars(image, params);
    ASSERT_GT(stars.count, 20);
    PictureSplats dots;
    add_picture_stars(stars, placement_without_fields(512, 256, params, 100.0), {}, dots);
    ASSERT_EQ(dots.splats.size(), stars.count);
    EXPECT_GE(dots.ranges.size(), 3u);
    for (const DotRange& range : dots.ranges)
        for (std::int64_t i = range.begin; i < range.end; ++i)
            EXPECT_NEAR(dots.splats.radius[static_cast<std::size_t>(i)] / radius_sigmas, range.sigma,
                        0.25f * range.sigma);
}

TEST(Knots, ThereAreNoneInAnEvenSky) {
    EXPECT_TRUE(find_knots(brightest_channel(sky(256, 128))).knots.empty());
}

}  // namespace
}  // namespace astrosplat
