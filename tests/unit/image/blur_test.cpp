// Blurs against a direct convolution in double precision, and what every blur keeps.
#include "image/blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace astrosplat {
namespace {

// Without structure of any scale, the same on every run.
Image noise(std::int64_t width, std::int64_t height, int channels) {
    Image image = make_image(width, height, channels);
    std::uint32_t state = 1;
    for (float& value : image.pixels) {
        state = state * 1664525u + 1013904223u;
        value = static_cast<float>(state >> 8) / 16777216.0f;
    }
    return image;
}

double sum(const Image& image) { return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0); }

std::int64_t reflected(std::int64_t i, std::int64_t n) {
    while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
    return i;
}

// The definition: every weight of the two-dimensional kernel, without a cut.
double direct(const Image& image, double sigma, std::int64_t x, std::int64_t y, int channel) {
    const auto reach = static_cast<std::int64_t>(std::ceil(8.0 * sigma));
    double weights = 0.0, result = 0.0;
    for (std::int64_t j = -reach; j <= reach; ++j)
        for (std::int64_t i = -reach; i <= reach; ++i) {
            const double w = std::exp(-0.5 * static_cast<double>(i * i + j * j) / (sigma * sigma));
            weights += w;
            result += w * image.at(reflected(x + i, image.width), reflected(y + j, image.height))[channel];
        }
    return result / weights;
}

TEST(Blur, IsTheConvolutionWithAGaussian) {
    const Image image = noise(23, 17, 3);
    for (const double sigma : {0.4, 1.0, 2.5, 6.0}) {
        const Image blurred = convolved_with_gaussian(image, sigma);
        // The kernel's ends beyond 4 sigma hold 6e-5 of its weight a side and axis.
        for (const auto& [x, y] : {std::pair{0, 0}, {22, 16}, {11, 8}, {3, 15}})
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(blurred.at(x, y)[c], direct(image, sigma, x, y, c), 1.5e-4) << sigma << " " << x;
    }
}

TEST(Blur, HalvedEarlyIsWithinAThirdOfThePeak) {
    Image image = make_image(64, 64, 3);
    image.at(31, 30)[1] = 1.0f;
    for (const double sigma : {1.26, 1.5, 2.2, 3.9}) {
        const Image exact = convolved_with_gaussian(image, sigma), quick = gaussian_blur(image, sigma, 1.25);
        EXPECT_NE(quick.pixels, exact.pixels) << sigma;
        const float peak = exact.at(31, 30)[1];
        for (std::size_t i = 0; i < exact.pixels.size(); ++i)
            ASSERT_NEAR(quick.pixels[i], exact.pixels[i], 0.34f * peak) << sigma;
    }
}

// Whatever part of a row vectors of any length take.
TEST(Blur, RowsAreWeightedAlikeAtEveryPlace) {
    const std::vector<float> weights{0.25f, -0.5f, 1.7f};
    const Image image = noise(400, 3, 1);
    const std::vector<const float*> rows{image.at(0, 0), image.at(0, 1), image.at(0, 2)};
    for (const std::int64_t count : {1, 3, 16, 63, 64, 65, 130, 257, 400}) {
        std::vector<float> out(401, -1.0f);
        weighted_rows(weights, rows, count, out.data());
        for (std::int64_t i = 0; i < count; ++i) {
            float sum = 0.0f;
            for (std::size_t k = 0; k < 3; ++k) sum += weights[k] * rows[k][i];
            ASSERT_EQ(out[static_cast<std::size_t>(i)], sum) << count << " " << i;
        }
        ASSERT_EQ(out[static_cast<std::size_t>(count)], -1.0f) << count;
    }
}

TEST(Blur, OfAPointIsWithinAHundredthOfTheGaussiansPeak) {
    Image image = make_image(256, 256, 1);
    *image.at(127, 130) = 1.0f;
    for (const double sigma : {3.0, 4.01, 5.0, 8.1, 13.0}) {
        const Image blurred = gaussian_blur(image, sigma);
        const double peak = 1.0 / (2.0 * 3.14159265358979 * sigma * sigma);
        double worst = 0.0;
        for (std::int64_t y = 80; y < 180; ++y)
            for (std::int64_t x = 80; x < 180; ++x) {
                const double r2 = static_cast<double>((x - 127) * (x - 127) + (y - 130) * (y - 130));
                worst = std::max(worst,
                                 std::fabs(*blurred.at(x, y) - peak * std::exp(-0.5 * r2 / (sigma * sigma))));
            }
        EXPECT_LT(worst, 0.01 * peak) << sigma;
    }
}

// The kernel itself would be of ten thousand rows.
TEST(Blur, OfAStripIsAsWideAsItsKernel) {
    Image strip = make_image(30000, 3, 1);
    for (std::int64_t y = 0; y < 3; ++y) *strip.at(15000, y) = 1.0f;
    const Image blurred = gaussian_blur(strip, 1250.0);
    for (const std::int64_t x : {12000, 13750, 15000, 16250}) {
        const double t = static_cast<double>(x - 15000) / 1250.0;
        EXPECT_NEAR(*blurred.at(x, 1), std::exp(-0.5 * t * t) / (1250.0 * std::sqrt(2.0 * 3.14159265358979)),
                    1e-5);
    }
}

TEST(Blur, KeepsConstantsAndTheSum) {
    for (const double sigma : {0.0, 0.7, 2.0, 4.0, 11.0}) {
        for (const auto& [width, height] : {std::pair{64, 48}, {31, 45}, {5, 3}, {1, 1}}) {
            const Image flat = gaussian_blur(make_image(width, height, 2, 0.25f), sigma);
            for (const float value : flat.pixels) ASSERT_NEAR(value, 0.25f, 1e-6f) << sigma;
            const Image image = noise(width, height, 2);
            const bool even =
                width % 16 == 0;  // else the edges weigh a little more or less where it is halved
            const double before = sum(image), after = sum(gaussian_blur(image, sigma));
            EXPECT_NEAR(after / before, 1.0, even || sigma <= 4.0 ? 1e-5 : 0.05) << sigma << " " << width;
            EXPECT_NEAR(sum(convolved_with_gaussian(image, sigma)) / before, 1.0, 1e-5)
                << sigma << " " << width;
        }
    }
}

TEST(Blur, HalvingAndDoublingKeepARampAwayFromTheEdges) {
    Image ramp = make_image(33, 8, 1);
    for (std::int64_t y = 0; y < 8; ++y)
        for (std::int64_t x = 0; x < 33; ++x) *ramp.at(x, y) = static_cast<float>(x);
    const Image half = halved(ramp);
    ASSERT_EQ(half.width, 17);
    ASSERT_EQ(half.height, 4);
    for (std::int64_t x = 1; x < 15; ++x)
        EXPECT_FLOAT_EQ(*half.at(x, 2), 2.0f * static_cast<float>(x) + 0.5f);
    const Image again = doubled(half, 33, 8);
    for (std::int64_t x = 3; x < 29; ++x) EXPECT_FLOAT_EQ(*again.at(x, 3), static_cast<float>(x));
}

}  // namespace
}  // namespace astrosplat
