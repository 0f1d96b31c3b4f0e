// A sky of cut-outs: as much light and as many objects as the picture has, none of them cut, and neighbours
// that show different parts of it.
#include "source/tiled_sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "detect/parts.h"
#include "support/errors.h"
#include "support/painted_picture.h"

namespace astrosplat {
namespace {

constexpr std::int64_t picture_px = 240;
constexpr int galaxies = 30;
constexpr double sigma_px = 1.6, peak = 0.5, sky = 0.02;

// Galaxies apart from each other on a sky with a little grain.
Image deep_field() {
    Image image = make_image(picture_px, picture_px, 3);
    for (std::int64_t y = 0; y < picture_px; ++y)
        for (std::int64_t x = 0; x < picture_px; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] =
                    static_cast<float>(sky + 0.002 * double(painted::fbm(double(x), double(y), 0.31, 9u)));
    for (int n = 0; n < galaxies; ++n) {
        const double x = 14.0 + 40.0 * (n % 6) + 12.0 * painted::random(std::uint32_t(n), 71),
                     y = 18.0 + 46.0 * (n / 6) + 12.0 * painted::random(std::uint32_t(n), 72);
        painted::add_point(image, x, y, sigma_px, peak, 0.8 * peak, 0.6 * peak);
    }
    return image;
}

SkyTiling small_tiling(std::uint32_t seed = 1) { return {60.0, seed, 256}; }

double solid_angle(double x, double y, double n) {
    const double s = 2.0 * x / n - 1.0, t = 2.0 * y / n - 1.0, square = 1.0 + s * s + t * t;
    return 4.0 / (n * n * square * std::sqrt(square));
}

TEST(TiledSky, HasThePicturesLightAndItsObjectsWholeAndAsMany) {
    const Image picture = deep_field();
    double light = 0.0, of_picture = 0.0, all = 0.0;
    int found = 0, cut = 0;
    // A galaxy's light over the sky: its texels are the picture's.
    const double texel = real::radians(60.0) / double(picture_px);
    const double own = 2.0 * real::pi * sigma_px * sigma_px * peak * texel * texel;
    constexpr std::uint32_t seeds = 4;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed)
        for (const Image& face : tiled_sky(picture, small_tiling(seed))) {
            const auto n = static_cast<double>(face.width);
            for (std::int64_t y = 0; y < face.height; ++y)
                for (std::int64_t x = 0; x < face.width; ++x) {
                    const double share = solid_angle(double(x) + 0.5, double(y) + 0.5, n);
                    all += share;
                    light += share * double(face.at(x, y)[0]);
                    if (x < 6 || y < 6 || x >= face.width - 6 || y >= face.height - 6) continue;
                    const float here = face.at(x, y)[0];
                    bool highest = here > 0.15f;
                    for (std::int64_t j = -2; j <= 2 && highest; ++j)
                        for (std::int64_t i = -2; i <= 2; ++i)
                            highest = highest && (face.at(x + i, y + j)[0] < here || (i == 0 && j == 0));
                    if (!highest) continue;
                    double sum = 0.0;
                    for (std::int64_t j = -6; j <= 6; ++j)
                        for (std::int64_t i = -6; i <= 6; ++i)
                            sum += (double(face.at(x + i, y + j)[0]) - sky) *
                                   solid_angle(double(x + i) + 0.5, double(y + j) + 0.5, n);
                    ++found;
                    cut += sum < 0.7 * own ? 1 : 0;
                }
        }
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3) of_picture += double(picture.pixels[i]);
    EXPECT_NEAR(all / seeds, 4.0 * real::pi, 1e-3);
    EXPECT_NEAR(light / all / (of_picture / double(picture_px * picture_px)), 1.0, 0.01);
    // Those in the rims of the faces are not looked at.
    const double inside = std::pow(244.0 / 256.0, 2.0);
    const double expected =
        seeds * inside * galaxies * 4.0 * real::pi / (texel * texel * double(picture_px * picture_px));
    EXPECT_NEAR(found / expected, 1.0, 0.12);
    EXPECT_LE(cut, found / 50);
}

TEST(TiledSky, APlainPictureMakesAPlainSky) {
    Image plain = make_image(64, 48, 4);
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) plain.pixels[i] = 0.25f;
    for (const Image& face : tiled_sky(plain, {30.0, 1, 64}))
        for (const float value : face.pixels) ASSERT_NEAR(value, 0.25f, 1e-5f);
    EXPECT_EQ(ERROR_OF(tiled_sky(make_image(64, 31, 3), {})),
              "environment.tile: expected a picture of at least 32 px a side, found 31");
}

TEST(SkyPatches, CoverTheSkyWithPartsThatNeighboursDoNotShare) {
    constexpr double reach_px = 60.0, px_per_radian = 300.0;
    const SkyPatches patches(glm::dvec2(400.0, 300.0), reach_px, 20.0, px_per_radian, 7);
    for (int n = 0; n < 2000; ++n) {
        const double z = 2.0 * painted::random(std::uint32_t(n), 81) - 1.0,
                     a = 2.0 * real::pi * painted::random(std::uint32_t(n), 82), r = std::sqrt(1.0 - z * z);
        const glm::dvec3 d(r * std::cos(a), r * std::sin(a), z);
        const SkyPatch& patch = patches.all()[patches.nearest(d)];
        ASSERT_LT(glm::distance(patch.middle, d), 0.97 * patches.reach());
        const glm::dvec2 place = patch.place(d, px_per_radian);
        ASSERT_LT(glm::distance(place, patch.picture), reach_px);
        ASSERT_TRUE(place.x >= 0.0 && place.y >= 0.0 && place.x <= 400.0 && place.y <= 300.0);
        ASSERT_LT(glm::distance(patch.direction(place, px_per_radian), d), 1e-9);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < patches.all().size(); ++i) {
        double nearest = 1e9;
        for (std::size_t j = 0; j < patches.all().size(); ++j)
            if (i != j &&
                glm::distance(patches.all()[i].middle, patches.all()[j].middle) < 1.3 * patches.spacing())
                nearest =
                    std::fmin(nearest, glm::distance(patches.all()[i].picture, patches.all()[j].picture));
        sum += std::fmin(nearest, 400.0);
    }
    EXPECT_GT(sum / double(patches.all().size()), 50.0) << "at random they are 40 px apart";
}

TEST(PictureObjects, AreFoundAndTakenOut) {
    const PictureObjects found = find_objects(deep_field(), 20.0);
    EXPECT_GE(found.objects.size(), std::size_t{galaxies});
    EXPECT_LE(found.objects.size(), std::size_t{galaxies + 6}) << "grain, now and then";
    const Image picture = deep_field();
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        ASSERT_FLOAT_EQ(found.light.pixels[i] + found.sky.pixels[i], picture.pixels[i]);
        ASSERT_LT(found.sky.pixels[i], 0.06f) << "no galaxy is left";
    }
    EXPECT_TRUE(find_objects(deep_field(), 1.0).objects.empty()) << "all reach farther";
}

TEST(TiledSky, IsAnotherForAnotherSeed) {
    const Image picture = deep_field();
    EXPECT_NE(tiled_sky(picture, {60.0, 1, 64})[3].pixels, tiled_sky(picture, {60.0, 2, 64})[3].pixels);
}

}  // namespace
}  // namespace astrosplat
