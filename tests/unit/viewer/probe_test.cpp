// What the status bar says of the pixel under the mouse, against pixels written by hand.
#include <gtest/gtest.h>

#include "viewer/session_parts.h"

namespace astrosplat {
namespace {

/// 3 x 2 px, red is 10 x + y, the other channels 1.
Image numbered() {
    Image image = make_image(3, 2, 4, 1.0f);
    for (std::int64_t y = 0; y < 2; ++y)
        for (std::int64_t x = 0; x < 3; ++x) image.at(x, y)[0] = static_cast<float>(10 * x + y);
    return image;
}

TEST(Probe, IsThePixelAndItsDepth) {
    const Image pixels = numbered();
    Image depth = make_image(3, 2, 1, 0.0f);
    *depth.at(2, 1) = 7.5f;
    const auto found = probe_of(pixels, &depth, {}, 2, 1);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->x, 2);
    EXPECT_EQ(found->y, 1);
    EXPECT_EQ(found->rgba[0], 21.0f);
    EXPECT_EQ(found->rgba[3], 1.0f);
    EXPECT_EQ(found->depth, 7.5f);
    EXPECT_FALSE(probe_of(pixels, &depth, {}, 1, 1)->depth) << "nothing is there";
    EXPECT_FALSE(probe_of(pixels, nullptr, {}, 2, 1)->depth) << "of previews";
    const Image without;
    EXPECT_FALSE(probe_of(pixels, &without, {}, 2, 1)->depth) << "of scenes that write none";
}

TEST(Probe, CountsFromTheWholePicture) {
    const Image pixels = numbered();
    const Region part{100, 50, 3, 2};
    const auto found = probe_of(pixels, nullptr, part, 101, 51);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->x, 101);
    EXPECT_EQ(found->rgba[0], 11.0f);
    for (const auto& [x, y] : {std::pair{99, 50}, {103, 50}, {100, 49}, {100, 52}})
        EXPECT_FALSE(probe_of(pixels, nullptr, part, x, y)) << x << " " << y;
}

}  // namespace
}  // namespace astrosplat
