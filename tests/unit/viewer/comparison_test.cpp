// Numbers of a difference, and thumbnails of snapshots, that can be worked out by hand.
#include "viewer/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/color.h"

namespace astrosplat {
namespace {

TEST(DifferenceMeter, EvenPicturesDifferByTheirValues) {
    const Image a = make_image(5, 4, 4, 0.6f), b = make_image(5, 4, 4, 1.0f);
    Image half = b;
    for (std::size_t i = 0; i < half.pixels.size(); ++i)
        if (i % 4 != 3) half.pixels[i] = 0.5f;
    const auto found = difference_of(a, half);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->mean, 0.1, 1e-6);
    EXPECT_NEAR(found->psnr_db, 20.0, 1e-4);
    EXPECT_NEAR(found->light, real::srgb_to_linear(0.6) / real::srgb_to_linear(0.5), 1e-5);
}

TEST(DifferenceMeter, SignsCancelInTheMeanOnly) {
    Image a = make_image(2, 1, 4, 0.5f), b = make_image(2, 1, 4, 0.5f);
    a.at(0, 0)[1] = 0.7f;
    a.at(1, 0)[1] = 0.3f;
    b.at(0, 0)[3] = b.at(1, 0)[3] = 1.0f;
    const auto found = difference_of(a, b);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->mean, 0.0, 1e-7);
    EXPECT_NEAR(found->psnr_db, -10.0 * std::log10(0.04 / 3.0), 1e-4);
}

TEST(DifferenceMeter, OnlyWhereBothAreSeen) {
    const Image a = make_image(3, 1, 4, 0.25f);
    Image b = make_image(3, 1, 4, 0.0f);
    EXPECT_FALSE(difference_of(a, b));
    for (int c = 0; c < 4; ++c) b.at(1, 0)[c] = c == 3 ? 1.0f : 0.25f;
    const auto found = difference_of(a, b);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->mean, 0.0);
    EXPECT_TRUE(std::isinf(found->psnr_db));
    EXPECT_EQ(found->light, 1.0);
}

TEST(DifferenceMeter, BlackAgainstBlackHasTheSameLight) {
    Image a = make_image(1, 1, 4, 0.0f), b = a;
    b.at(0, 0)[3] = 1.0f;
    EXPECT_EQ(difference_of(a, b)->light, 1.0);
    a.at(0, 0)[0] = 0.5f;
    EXPECT_TRUE(std::isinf(difference_of(a, b)->light));
}

TEST(Thumbnail, AveragesBoxes) {
    // 4 x 3 px into boxes of 2 x 2; the row that is left over is dropped.
    std::vector<unsigned char> rgba;
    for (int i = 0; i < 12; ++i)
        for (int c = 0; c < 4; ++c) rgba.push_back(static_cast<unsigned char>(c == 3 ? 255 : 10 * i + c));
    const Image small = thumbnail_of(rgba, 4, 3, 2);
    ASSERT_EQ(small.width, 2);
    ASSERT_EQ(small.height, 1);
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(small.at(0, 0)[c], (25.0f + static_cast<float>(c)) / 255.0f);
        EXPECT_FLOAT_EQ(small.at(1, 0)[c], (45.0f + static_cast<float>(c)) / 255.0f);
    }
    EXPECT_EQ(small.at(1, 0)[3], 1.0f);
    EXPECT_EQ(thumbnail_of(rgba, 4, 3, 8).width, 4) << "small pictures stay as they are";
    const Image low = thumbnail_of(std::vector<unsigned char>(8 * 4, 51), 8, 1, 2);  // blocks of 4 x 1 px
    EXPECT_EQ(low.width, 2);
    EXPECT_EQ(low.height, 1);
    EXPECT_FLOAT_EQ(low.at(1, 0)[0], 0.2f);
}

}  // namespace
}  // namespace astrosplat
