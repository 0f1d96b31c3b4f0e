#include "bodies/picture_light.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/painted_picture.h"

namespace astrosplat {
namespace {

std::vector<Image> all_bands(const Image& light) {
    std::vector<Image> images;
    const std::vector<Band> bands = make_bands(light.width);
    split_bands(light, bands, false, [&](const Band& band, const Image& image) {
        EXPECT_EQ(band.index, static_cast<int>(images.size()));
        images.push_back(image);
    });
    EXPECT_EQ(images.size(), bands.size());
    return images;
}

TEST(Bands, LargerPicturesHaveMoreOfThem) {
    EXPECT_EQ(make_bands(1920).size(), 8u);
    EXPECT_EQ(make_bands(3840).size(), 9u);
    EXPECT_EQ(make_bands(480).size(), 6u);
    for (const Band& band : make_bands(1920)) {
        if (band.index + 1 < 8) {
            EXPECT_NEAR(band.feature, 2.0 * (1 << band.index), 1e-9) << band.index;
        }
    }
}

TEST(Bands, AddUpToThePictureAndAreNeverNegative) {
    const Image light = painted::galaxy(240, 150);
    const std::vector<Image> bands = all_bands(light);
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        double sum = 0.0;
        for (const Image& band : bands) {
            ASSERT_GE(band.pixels[i], 0.0f);
            sum += static_cast<double>(band.pixels[i]);
        }
        ASSERT_NEAR(sum, light.pixels[i], 4e-7 * (1.0 + static_cast<double>(light.pixels[i]))) << "at " << i;
    }
}

TEST(Bands, WhatIsEvenIsInTheCoarsest) {
    Image light = make_image(160, 100, 3, 0.25f);
    const std::vector<Image> bands = all_bands(light);
    for (std::size_t k = 0; k + 1 < bands.size(); ++k)
        for (const float v : bands[k].pixels) ASSERT_NEAR(v, 0.0f, 2e-4f) << "band " << k;
    for (const float v : bands.back().pixels) ASSERT_NEAR(v, 0.25f, 1e-3f);
}

// A dot of a size is in the band of that size, not in the finest: this is what gives it a thickness of its
// own.
TEST(Bands, HoldWhatIsOfTheirSize) {
    for (const int wanted : {0, 2}) {
        Image light = make_image(320, 320, 3);
        painted::add_point(light, 160.0, 160.0, wanted == 0 ? 0.8 : 5.0, 1.0, 1.0, 1.0);
        const std::vector<Image> bands = all_bands(light);
        std::size_t strongest = 0;
        for (std::size_t k = 1; k < bands.size(); ++k)
            if (bands[k].at(160, 160)[0] > bands[strongest].at(160, 160)[0]) strongest = k;
        if (wanted == 0) {
            EXPECT_EQ(strongest, 0u);
        } else {
            EXPECT_GE(strongest, 1u);
            EXPECT_LE(strongest, 3u);
        }
    }
}

// Where the sum of filled bands is more than the picture, there is dust.
TEST(Bands, AStarMakesNoDustAroundItButALaneIsDust) {
    Image light = make_image(320, 200, 3, 0.1f);
    painted::add_point(light, 100.0, 100.0, 2.4, 5.0, 5.0, 5.0);
    for (std::int64_t y = 0; y < 200; ++y)
        for (std::int64_t x = 220; x < 226; ++x)
            for (int c = 0; c < 3; ++c) light.at(x, y)[c] = 0.02f;
    Image sum = make_image(320, 200, 3);
    split_bands(light, make_bands(320), true, [&](const Band&, const Image& band) {
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += band.pixels[i];
    });
    const auto filled = [&](std::int64_t x, std::int64_t y) { return sum.at(x, y)[1] / light.at(x, y)[1]; };
    for (std::int64_t x = 60; x < 140; ++x) EXPECT_LT(filled(x, 100), 1.3f) << x;
    EXPECT_GT(filled(223, 60), 2.0f);
}

}  // namespace
}  // namespace astrosplat
