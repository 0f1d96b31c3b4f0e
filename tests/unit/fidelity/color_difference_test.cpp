// CIEDE2000 against the published pairs, and L*a*b* of known colours.
#include "fidelity/display.h"

#include <gtest/gtest.h>

#include "drawn.h"

namespace astrosplat {
namespace {

// Sharma, Wu, Dalal (2005), table 1: two colours and their difference, to four decimals.
constexpr double published[][7] = {
    {50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425},
    {50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615},
    {50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412},
    {50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669},
    {50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461},
    {50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065},
    {50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492},
    {50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977},
    {50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030},
    {50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
};

TEST(Ciede2000, IsThatOfThePublishedPairs) {
    for (const auto& p : published) {
        const Lab first{p[0], p[1], p[2]}, second{p[3], p[4], p[5]};
        EXPECT_NEAR(ciede2000(first, second), p[6], 5.1e-5) << p[1] << " " << p[2] << " to " << p[4];
        EXPECT_NEAR(ciede2000(second, first), p[6], 5.1e-5) << p[1] << " " << p[2] << " from " << p[4];
    }
}

TEST(Lab, OfKnownColours) {
    const float white[] = {1.0f, 1.0f, 1.0f}, grey[] = {0.18f, 0.18f, 0.18f}, red[] = {1.0f, 0.0f, 0.0f};
    for (const auto& [color, lightness] : {std::pair{white, 100.0}, {grey, 49.496}}) {
        const Lab lab = lab_of_linear(color);
        EXPECT_NEAR(lab.L, lightness, 1e-3);
        EXPECT_NEAR(lab.a, 0.0, 1e-4);
        EXPECT_NEAR(lab.b, 0.0, 1e-4);
    }
    const Lab lab = lab_of_linear(red);
    EXPECT_NEAR(lab.L, 53.24, 0.01);
    EXPECT_NEAR(lab.a, 80.10, 0.01);
    EXPECT_NEAR(lab.b, 67.22, 0.01);
    const float black[] = {0.0f, 0.0f, 0.0f}, faint[] = {0.001f, 0.001f, 0.001f};
    EXPECT_NEAR(lab_of_linear(black).L, 0.0, 1e-12);
    EXPECT_NEAR(lab_of_linear(faint).L, 24389.0 / 27.0 * 0.001, 1e-6) << "the straight part";
    const float beyond[] = {3.0f, -1.0f, 0.0f};
    EXPECT_EQ(lab_of_linear(beyond).L, lab.L) << "clamped to what is displayed";
}

TEST(ColorDifferences, ArePercentilesOverThePixels) {
    const Image dark = make_image(40, 10, 3, 0.2f);
    Image image = dark;
    for (std::int64_t y = 0; y < 10; ++y)
        for (std::int64_t x = 0; x < 4; ++x) std::fill_n(image.at(x, y), 3, 0.4f);
    const ColorDifferences d = color_differences(image, dark);
    EXPECT_EQ(d.median, 0.0);
    EXPECT_EQ(d.percentile_95, ciede2000(lab_of_linear(image.at(0, 0)), lab_of_linear(dark.at(0, 0))));
}

// Larger pictures are looked at here and there: every step-th pixel both ways.
TEST(ColorDifferences, OfALargePictureAreThoseOfASample) {
    const Image a = drawn(
        2100, 1000, [](std::int64_t x, std::int64_t, int) { return 0.2 + 1e-4 * static_cast<double>(x); });
    const Image b = drawn(
        2100, 1000, [](std::int64_t x, std::int64_t, int) { return 0.2 + 2e-4 * static_cast<double>(x); });
    const Image left = drawn(1, 1, [](std::int64_t, std::int64_t, int) { return 0.2 + 0.105; });
    const Image right = drawn(1, 1, [](std::int64_t, std::int64_t, int) { return 0.2 + 0.21; });
    const double middle = ciede2000(lab_of_linear(left.at(0, 0)), lab_of_linear(right.at(0, 0)));
    EXPECT_NEAR(color_differences(a, b).median, middle, 0.01);
}

}  // namespace
}  // namespace astrosplat
