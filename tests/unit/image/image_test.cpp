// Pictures enlarged, reduced, blurred and opened, against plain sums.
#include <gmock/gmock.h>

#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The area filter against sums over the pixels covered, and enlarging against what each pixel was.

TEST(Area, EachPixelIsTheMeanOfWhatItCovers) {
    Image image = make_image(3, 2, 2);
    for (std::int64_t i = 0; i < 12; ++i) image.pixels[std::size_t(i)] = float(i);
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
        image.pixels[i] = i % 7 == 0 ? 0.0f : std::fmod(0.37f * float(i * i), 2.0f);
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
        for (std::int64_t x = 0; x < 5; ++x) *slope.at(x, y) = float(x + 1);
    const Image out = enlarged(slope, 2);
    for (std::int64_t x = 2; x < 8; ++x)  // at the ends it is level
        EXPECT_NEAR(*out.at(x, 3), 0.75 + 0.5 * double(x), 1e-5) << x;
}

TEST(Area, EnlargedLightIsFiniteAndNotBelowZero) {
    Image image = make_image(4, 1, 1);
    image.pixels = {1.0f, std::nanf(""), -3.0f, std::numeric_limits<float>::infinity()};
    const Image out = enlarged(image, 3);
    EXPECT_NEAR(out.at(0, 0)[0] + out.at(1, 0)[0] + out.at(2, 0)[0], 3.0, 1e-5);
    for (std::int64_t x = 3; x < 12; ++x)
        for (std::int64_t y = 0; y < 3; ++y) EXPECT_EQ(*out.at(x, y), 0.0f) << x;
}

// Pictures at another size: closed forms for what a pixel shows.

Image ramp(std::int64_t width, std::int64_t height) {
    Image image = make_image(width, height, 3);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            image.at(x, y)[0] = float(x) + 0.5f;
            image.at(x, y)[1] = float(y) + 0.5f;
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
    for (std::int64_t i = 0; i < 40 * 26; ++i) EXPECT_NEAR(small.pixels[std::size_t(3 * i + 2)], 1.0f, 1e-6f);
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

// Blurs against a direct convolution in double precision, and what every blur keeps.

// Without structure of any scale, the same on every run.
Image noise(std::int64_t width, std::int64_t height, int channels) {
    Image image = make_image(width, height, channels);
    std::uint32_t state = 1;
    for (float& value : image.pixels) {
        state = state * 1664525u + 1013904223u;
        value = float(state >> 8) / 16777216.0f;
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
    const auto reach = std::int64_t(std::ceil(8.0 * sigma));
    double weights = 0.0, result = 0.0;
    for (std::int64_t j = -reach; j <= reach; ++j)
        for (std::int64_t i = -reach; i <= reach; ++i) {
            const double w = std::exp(-0.5 * double(i * i + j * j) / (sigma * sigma));
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
            ASSERT_EQ(out[std::size_t(i)], sum) << count << " " << i;
        }
        ASSERT_EQ(out[std::size_t(count)], -1.0f) << count;
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
                const double r2 = double((x - 127) * (x - 127) + (y - 130) * (y - 130));
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
        const double t = double(x - 15000) / 1250.0;
        EXPECT_NEAR(*blurred.at(x, 1), std::exp(-0.5 * t * t) / (1250.0 * std::sqrt(2.0 * 3.14159265358979)),
                    1e-5);
    }
}

TEST(Blur, KeepsConstantsAndTheSum) {
    for (const double sigma : {0.0, 0.7, 2.0, 4.0, 11.0})
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

TEST(Blur, HalvingAndDoublingKeepARampAwayFromTheEdges) {
    Image ramp = make_image(33, 8, 1);
    for (std::int64_t y = 0; y < 8; ++y)
        for (std::int64_t x = 0; x < 33; ++x) *ramp.at(x, y) = float(x);
    const Image half = halved(ramp);
    ASSERT_EQ(half.width, 17);
    ASSERT_EQ(half.height, 4);
    for (std::int64_t x = 1; x < 15; ++x) EXPECT_FLOAT_EQ(*half.at(x, 2), 2.0f * float(x) + 0.5f);
    const Image again = doubled(half, 33, 8);
    for (std::int64_t x = 3; x < 29; ++x) EXPECT_FLOAT_EQ(*again.at(x, 3), float(x));
}

Image noise(std::int64_t width, std::int64_t height) {
    Image image = make_image(width, height, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i * 2654435761u % 1009u);
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

// Which pixels are visited, and in which order.

using testing::ElementsAre;
using testing::Pair;
using Places = std::vector<std::pair<std::int64_t, std::int64_t>>;

TEST(Channels, APixelsNeighboursAreThoseThatThePictureHas) {
    const Image image = make_image(4, 3, 1);
    Places places;
    const auto note = [&](std::int64_t x, std::int64_t y) { places.emplace_back(x, y); };
    for_each_about(image, 3, 0, 1, note);
    EXPECT_THAT(places, ElementsAre(Pair(2, 0), Pair(3, 0), Pair(2, 1), Pair(3, 1)));
    places.clear();
    for_each_between(image, -5, 2, 0, 9, note);
    EXPECT_THAT(places, ElementsAre(Pair(0, 2)));
    places.clear();
    for_each_between(image, 4, 0, 9, 2, note);
    EXPECT_TRUE(places.empty());
}

TEST(Channels, WithinARadiusArePixelsWhoseMiddlesAre) {
    const Image image = make_image(5, 5, 1);
    Places places;
    double farthest = 0.0;
    for_each_within(image, 2.5, 2.5, 1.0, [&](std::int64_t x, std::int64_t y, double dx, double dy) {
        places.emplace_back(x, y);
        farthest = std::max(farthest, dx * dx + dy * dy);
        EXPECT_EQ(dx, double(x) - 2.0);
        EXPECT_EQ(dy, double(y) - 2.0);
    });
    EXPECT_THAT(places, ElementsAre(Pair(2, 1), Pair(1, 2), Pair(2, 2), Pair(3, 2), Pair(2, 3)));
    EXPECT_EQ(farthest, 1.0);
}

TEST(Channels, EveryPixelIsChangedOnceOnAnyNumberOfThreads) {
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Image image = make_image(7, 50, 2, 1.0f);
        change_pixels(image, [](float* p) { p[1] += 2.0f; });
        for_each_pixel(image, [&](std::int64_t x, std::int64_t y) { image.at(x, y)[0] *= 5.0f; });
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            ASSERT_EQ(image.pixels[i], i % 2 == 0 ? 5.0f : 3.0f);
    }
    set_thread_count(0);
}

TEST(Channels, OpaqueLeavesOutWhatIsBehindBlue) {
    Image image = make_image(2, 1, 4, 0.25f);
    const Image opaqued = opaque(image);
    EXPECT_THAT(opaqued.pixels, ElementsAre(0.25f, 0.25f, 0.25f, 1.0f, 0.25f, 0.25f, 0.25f, 1.0f));
}

}  // namespace
}  // namespace astrosplat
