// Pictures at another size: closed forms for what a pixel shows.
#include "image/resample.h"

#include <gtest/gtest.h>

#include <cmath>

namespace astrosplat {
namespace {

Image ramp(std::int64_t width, std::int64_t height) {
    Image image = make_image(width, height, 3);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            image.at(x, y)[0] = static_cast<float>(x) + 0.5f;
            image.at(x, y)[1] = static_cast<float>(y) + 0.5f;
            image.at(x, y)[2] = 1.0f;
        }
    return image;
}

TEST(Resample, ARampShowsItsPlaceAwayFromTheEdges) {
    const Image image = ramp(120, 80);
    const Image small = resampled(image, map_to_width(image, 40, 26), 40, 26, 0.5);
    for (const auto& [x, y] : {std::pair{10, 5}, {20, 10}, {30, 19}}) {
        EXPECT_NEAR(small.at(x, y)[0], (x + 0.5) * 3.0, 1e-4);
        EXPECT_NEAR(small.at(x, y)[1], (y + 0.5) * 3.0 + 1.0, 1e-4);
    }
    for (std::int64_t i = 0; i < 40 * 26; ++i)
        EXPECT_NEAR(small.pixels[static_cast<std::size_t>(3 * i + 2)], 1.0f, 1e-6f);
}

TEST(Resample, OfTheSameSizeWithoutAFilterIsThePicture) {
    const Image image = ramp(31, 17);
    EXPECT_EQ(resampled(image, map_to_width(image, 31, 17), 31, 17, 0.0).pixels, image.pixels);
}

TEST(Resample, OutsideOfThePictureIsBlack) {
    const Image image = make_image(10, 10, 1, 1.0f);
    PixelMap map;
    map.offset = {-5.0, 0.0};
    const Image shifted = resampled(image, map, 20, 10, 0.0);
    for (std::int64_t x = 0; x < 20; ++x) EXPECT_EQ(*shifted.at(x, 4), x >= 5 && x < 15 ? 1.0f : 0.0f) << x;
}

TEST(Resample, APictureMayLieAcross) {
    const Image image = ramp(30, 20);
    PixelMap map;  // a quarter turn: to the right is up
    map.linear = {{0.0, -1.0}, {1.0, 0.0}};
    map.offset = {0.0, 20.0};
    const Image turned = resampled(image, map, 20, 30, 0.0);
    EXPECT_EQ(turned.at(4, 9)[0], 9.5f);
    EXPECT_EQ(turned.at(4, 9)[1], 15.5f);
}

TEST(Resample, TheFilterIsOfOutputPixels) {
    Image point = make_image(300, 300, 1);
    *point.at(148, 148) = 1.0f;  // the centre of output pixel (49, 49)
    const Image small = resampled(point, map_to_width(point, 100, 100), 100, 100, 0.5);
    // At 1.5 texels the peak is 1 / (2 pi 1.5^2), and one output pixel on e^(-1/2 (1 / .5)^2) of it.
    const double peak = 1.0 / (2.0 * 3.14159265358979 * 2.25);
    EXPECT_NEAR(*small.at(49, 49), peak, 1e-4 * peak);
    EXPECT_NEAR(*small.at(50, 49), peak * std::exp(-2.0), 1e-3 * peak);
}

}  // namespace
}  // namespace astrosplat
