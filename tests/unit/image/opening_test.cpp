#include "image/blur.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace astrosplat {
namespace {

Image noise(std::int64_t width, std::int64_t height) {
    Image image = make_image(width, height, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<float>(i * 2654435761u % 1009u);
    return image;
}

// By definition: over every window.
template <class Extreme>
Image brute(const Image& image, std::int64_t reach, Extreme extreme) {
    Image out = image;
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x)
            for (std::int64_t j = std::max<std::int64_t>(0, y - reach);
                 j <= std::min(image.height - 1, y + reach); ++j)
                for (std::int64_t i = std::max<std::int64_t>(0, x - reach);
                     i <= std::min(image.width - 1, x + reach); ++i)
                    *out.at(x, y) = extreme(*out.at(x, y), *image.at(i, j));
    return out;
}

TEST(Opening, IsTheLargestOfTheLeast) {
    for (const std::int64_t reach : {0, 1, 2, 3, 5, 12, 60}) {
        const Image image = noise(71, 43);
        const Image least = brute(image, reach, [](float a, float b) { return std::min(a, b); });
        const Image wanted = brute(least, reach, [](float a, float b) { return std::max(a, b); });
        EXPECT_EQ(opened(image, reach).pixels, wanted.pixels) << "reach " << reach;
    }
}

TEST(Opening, CutsPeaksOffAndLeavesSteps) {
    Image image = make_image(90, 60, 1, 1.0f);
    for (std::int64_t y = 0; y < 60; ++y)
        for (std::int64_t x = 50; x < 90; ++x) *image.at(x, y) = 3.0f;
    const Image step = image;
    for (std::int64_t y = 20; y < 28; ++y)
        for (std::int64_t x = 20; x < 28; ++x) *image.at(x, y) = 50.0f;
    EXPECT_EQ(opened(image, 4).pixels, step.pixels);
    EXPECT_EQ(opened(image, 3).pixels, image.pixels) << "as wide as the square";
}

}  // namespace
}  // namespace astrosplat
