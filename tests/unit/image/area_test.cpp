// The area filter against sums over the pixels covered, and enlarging against what each pixel was.
#include "image/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace astrosplat {
namespace {

TEST(Area, EachPixelIsTheMeanOfWhatItCovers) {
    Image image = make_image(3, 2, 2);
    for (std::int64_t i = 0; i < 12; ++i) image.pixels[static_cast<std::size_t>(i)] = static_cast<float>(i);
    const Image out = reduced_by_area(image, 2, 1);
    // The columns' means are 3, 5 and 7 (4, 6 and 8); a new one covers one and a half.
    EXPECT_NEAR(out.at(0, 0)[0], (3.0 + 0.5 * 5.0) / 1.5, 1e-5);
    EXPECT_NEAR(out.at(1, 0)[0], (0.5 * 5.0 + 7.0) / 1.5, 1e-5);
    EXPECT_NEAR(out.at(1, 0)[1], (0.5 * 6.0 + 8.0) / 1.5, 1e-5);
    EXPECT_EQ(reduced_by_area(image, 3, 2).pixels, image.pixels);
}

TEST(Area, EnlargedPixelsKeepTheirLightAndRiseTowardsBrighterNeighbours) {
    Image image = make_image(5, 4, 2);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = i % 7 == 0 ? 0.0f : std::fmod(0.37f * static_cast<float>(i * i), 2.0f);
    for (const int times : {1, 2, 3, 4}) {
        const Image out = enlarged(image, times);
        ASSERT_EQ(out.width, 5 * times);
        ASSERT_EQ(out.height, 4 * times);
        const Image back = reduced_by_area(out, 5, 4);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            EXPECT_NEAR(back.pixels[i], image.pixels[i], 1e-5) << times << " " << i;
    }
    Image slope = make_image(5, 3, 1);
    for (std::int64_t y = 0; y < 3; ++y)
        for (std::int64_t x = 0; x < 5; ++x) *slope.at(x, y) = static_cast<float>(x + 1);
    const Image out = enlarged(slope, 2);
    for (std::int64_t x = 2; x < 8; ++x)  // at the ends it is level
        EXPECT_NEAR(*out.at(x, 3), 0.75 + 0.5 * static_cast<double>(x), 1e-5) << x;
}

TEST(Area, EnlargedLightIsFiniteAndNotBelowZero) {
    Image image = make_image(4, 1, 1);
    image.pixels = {1.0f, std::nanf(""), -3.0f, std::numeric_limits<float>::infinity()};
    const Image out = enlarged(image, 3);
    EXPECT_NEAR(out.at(0, 0)[0] + out.at(1, 0)[0] + out.at(2, 0)[0], 3.0, 1e-5);
    for (std::int64_t x = 3; x < 12; ++x)
        for (std::int64_t y = 0; y < 3; ++y) EXPECT_EQ(*out.at(x, y), 0.0f) << x;
}

}  // namespace
}  // namespace astrosplat
