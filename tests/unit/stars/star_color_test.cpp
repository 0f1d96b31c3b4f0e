// Colours of stars against tables of black bodies.
#include "stars/star_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace astrosplat {
namespace {

double luminance_of(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

TEST(StarColor, TemperaturesAreBallesteros) {
    // 4600 (1 / (0.92 * 0.65 + 1.7) + 1 / (0.92 * 0.65 + 0.62)) by hand; Vega's B-V is 0.
    EXPECT_NEAR(star_temperature(0.65), 4600.0 * (1.0 / 2.298 + 1.0 / 1.218), 1e-6);
    EXPECT_NEAR(star_temperature(0.0), 4600.0 / 1.7 + 4600.0 / 0.62, 1e-6);
    EXPECT_NEAR(star_temperature(0.65), 5778.0, 10.0);  // the Sun
}

// CIE 1931 chromaticities of the Planckian locus, as in tables of it (G. Wyszecki and W. S. Stiles, "Color
// Science", 1982, table 1(3.11)); Wyman's fits are good for some thousandths.
TEST(StarColor, BlackBodiesLieOnThePlanckianLocus) {
    struct Known {
        double kelvin, x, y;
    };
    for (const Known& known :
         {Known{3000, 0.4369, 0.4041}, Known{4000, 0.3805, 0.3768}, Known{5000, 0.3451, 0.3516},
          Known{6500, 0.3135, 0.3237}, Known{10000, 0.2807, 0.2884}}) {
        const glm::dvec3 c = black_body_color(known.kelvin);
        const glm::dvec3 xyz(0.4124 * c.x + 0.3576 * c.y + 0.1805 * c.z,
                             0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z,
                             0.0193 * c.x + 0.1192 * c.y + 0.9505 * c.z);
        const double sum = xyz.x + xyz.y + xyz.z;
        EXPECT_NEAR(xyz.x / sum, known.x, 0.004) << known.kelvin;
        EXPECT_NEAR(xyz.y / sum, known.y, 0.004) << known.kelvin;
    }
}

TEST(StarColor, TheSunIsNearlyWhiteAndCoolStarsAreRed) {
    const glm::dvec3 sun = black_body_color(5772.0);
    EXPECT_GT(sun.x, sun.y);
    EXPECT_GT(sun.y, sun.z);
    EXPECT_LT(sun.x / sun.z, 1.5);
    const glm::dvec3 cool = black_body_color(3000.0), hot = black_body_color(20000.0);
    EXPECT_GT(cool.x / cool.z, 5.0);
    EXPECT_LT(hot.x / hot.z, 0.6);
}

TEST(StarColor, EveryColorHasLuminanceOneAndNoNegativeChannel) {
    const StarColors colors;
    for (double bv = -1.0; bv < 8.0; bv += 0.013) {
        const glm::dvec3 c = colors(bv);
        EXPECT_NEAR(luminance_of(c), 1.0, 1e-12) << bv;
        EXPECT_GE(std::min({c.x, c.y, c.z}), 0.0) << bv;
    }
    for (const double kelvin : {500.0, 1000.0, 1e5, 1e7})
        EXPECT_NEAR(luminance_of(black_body_color(kelvin)), 1.0, 1e-12) << kelvin;
}

TEST(StarColor, TheTableGivesTheFormulasColors) {
    const StarColors colors;
    for (const double bv : {-0.4, -0.123, 0.0, 0.655, 1.7183, 5.0}) {
        const glm::dvec3 c = colors(bv), exact = black_body_color(star_temperature(bv));
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(c[i], exact[i], 2e-4 * exact[i] + 1e-6) << bv;
    }
    EXPECT_EQ(colors(std::nullopt), colors(0.65));
    EXPECT_EQ(colors(-3.0), colors(-0.4));
    EXPECT_EQ(colors(30.0), colors(5.0));
}

}  // namespace
}  // namespace astrosplat
