// Sky, cuts, colours and grids: closed forms.
#include <gtest/gtest.h>

#include "core/color.h"
#include "core/real.h"
#include "prepare/filters.h"
#include "prepare/sky.h"
#include "unit/prepare/painted.h"

namespace astrosplat {
namespace {

TEST(Sky, IsFoundBehindAGalaxy) {
    const auto sky = [](double x, double y, int c) {
        const double u = x / 200.0 - 1.0, v = y / 150.0 - 1.0;
        return 0.1 + 0.02 * c + 0.03 * u - 0.02 * v + (c == 2 ? 0.015 * u * v + 0.01 * u * u : 0.0);
    };
    const Image image = add_noise(painted(400, 300, 3,
                                          [&](double x, double y, int c) {
                                              const double r = std::hypot(x - 190.0, 1.5 * (y - 160.0));
                                              return sky(x, y, c) + 0.8 * std::exp(-r / 30.0);
                                          }),
                                  0.01, 4);
    const SkySurface found = fit_sky(image, 2);
    for (int c = 0; c < 3; ++c)
        for (const double u : {-0.9, 0.0, 0.9})
            for (const double v : {-0.9, 0.0, 0.9})
                EXPECT_NEAR(found.at(u, v, c), sky(200.0 * (u + 1.0), 150.0 * (v + 1.0), c), 0.008)
                    << u << " " << v;
}

TEST(Sky, OfALowerDegreeIsALevelOrAPlane) {
    const Image image = painted(
        240, 160, 4, [](double x, double y, int c) { return c == 3 ? 0.5 : 0.1 + 0.001 * x - 0.0005 * y; });
    const SkySurface plane = fit_sky(image, 1), level = fit_sky(image, 0);
    EXPECT_NEAR(plane.at(0.0, 0.0, 1), 0.1 + 0.12 - 0.04, 1e-3);
    EXPECT_NEAR(plane.at(1.0, -1.0, 1), 0.1 + 0.24, 2e-3);
    EXPECT_EQ(level.at(0.7, -0.3, 0), level.at(0.0, 0.0, 0));
    Image left = painted(240, 160, 4, [](double x, double y, int c) {
        return c == 3 ? 0.5 : 0.5 * (0.1 + 0.001 * x - 0.0005 * y);
    });
    subtract_sky(left, plane);
    for (std::int64_t i = 0; i < 240 * 160; ++i) {
        ASSERT_NEAR(left.pixels[4 * i], 0.0f, 2e-3f) << "what the alpha lets through of it";
        ASSERT_EQ(left.pixels[4 * i + 3], 0.5f);
    }
}

TEST(Cut, AnEllipseHasItsAreaAndFadesInwards) {
    const CutEllipse sharp{{50.0, 40.0}, {30.0, 12.0}, 30.0, 0.0};
    Image image = make_image(100, 80, 4, 1.0f);
    cut_ellipse(image, sharp);
    double area = 0.0;
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) area += static_cast<double>(image.pixels[i]);
    EXPECT_NEAR(area / (real::pi * 30.0 * 12.0), 1.0, 0.01);
    EXPECT_EQ(inside(sharp, 50.0 + 29.0 * std::cos(real::pi / 6.0), 40.0 + 29.0 * 0.5), 1.0);
    EXPECT_EQ(inside(sharp, 50.0 + 29.0 * std::cos(real::pi / 6.0), 40.0 - 29.0 * 0.5), 0.0);
    const CutEllipse soft{{0.0, 0.0}, {10.0, 10.0}, 0.0, 0.4};
    EXPECT_EQ(inside(soft, 6.0, 0.0), 1.0);
    EXPECT_NEAR(inside(soft, 0.0, 8.0), 0.5, 1e-12);
    EXPECT_EQ(inside(soft, 10.0, 0.0), 0.0);
}

TEST(Cut, MaskAndLuminanceMakeAlpha) {
    Image image =
        painted(4, 1, 4, [](double x, double, int c) { return c == 3 ? 1.0 : 0.1 * x; });  // .05 .15 .25 .35
    Image by_mask = image;
    cut_with_mask(by_mask, painted(4, 1, 3, [](double x, double, int) { return x > 2.0 ? 0.5 : 0.0; }));
    EXPECT_EQ(by_mask.at(1, 0)[3], 0.0f);
    EXPECT_EQ(by_mask.at(2, 0)[3], 0.5f);
    EXPECT_FLOAT_EQ(by_mask.at(2, 0)[0], 0.125f);
    alpha_from_luminance(image, 0.15, 0.35);
    EXPECT_EQ(image.at(0, 0)[0], 0.0f);
    EXPECT_NEAR(image.at(1, 0)[3], 0.0f, 1e-6f);
    EXPECT_NEAR(image.at(2, 0)[3], 0.5f, 1e-6f);
    EXPECT_FLOAT_EQ(image.at(2, 0)[1], 0.25f);
    EXPECT_FLOAT_EQ(image.at(3, 0)[3], 1.0f);
}

TEST(Lupton, KeepsColoursAndIsLinearWhereItIsFaint) {
    const auto shown = [](std::array<float, 3> light) {
        Image image = make_image(1, 1, 3);
        std::copy(light.begin(), light.end(), image.pixels.begin());
        apply_lupton(image, {8.0, 0.1});
        std::array<double, 3> values;
        for (std::size_t c = 0; c < 3; ++c)
            values[c] = real::linear_to_srgb(static_cast<double>(image.pixels[c]));
        return values;
    };
    const double tenth = 0.1 / std::asinh(0.8);
    const auto middle = shown({0.2f, 0.1f, 0.3f});  // mean .2
    EXPECT_NEAR(middle[1], tenth * std::asinh(16.0) * 0.5, 1e-5);
    EXPECT_NEAR(middle[0] / middle[1], 2.0, 1e-4);
    EXPECT_NEAR(middle[2] / middle[1], 3.0, 1e-4);
    const auto faint = shown({1e-4f, 1e-4f, 1e-4f});
    EXPECT_NEAR(faint[0], tenth * 8e-3, 1e-6);
    const auto bright = shown({900.0f, 300.0f, 600.0f});
    EXPECT_NEAR(bright[0], 1.0, 1e-6);
    EXPECT_NEAR(bright[1], 1.0 / 3.0, 1e-5);
    EXPECT_EQ(shown({-1.0f, -2.0f, 0.0f})[0], 0.0);
}

// A grid of so many degrees a pixel, turned; north up and east left when it is not.
TanGrid grid(const glm::dvec2& px, const glm::dvec2& sky, double scale, double turn_deg) {
    const double c = scale * std::cos(real::radians(turn_deg)), s = scale * std::sin(real::radians(turn_deg));
    return {px, sky, {-c, s, s, c}};
}

TEST(SkyGrid, KnowsWhereNorthAndEastAre) {
    const TanGrid g = grid({50.5, 40.5}, {83.8, -5.4}, 0.01, 0.0);
    EXPECT_NEAR(sky_at(g, {50.5, 40.5}).x, 83.8, 1e-12);
    EXPECT_NEAR(sky_at(g, {50.5, 50.5}).y, -5.3, 1e-6) << "north is up";
    EXPECT_NEAR(sky_at(g, {40.5, 40.5}).x, 83.8 + 0.1 / std::cos(real::radians(5.4)), 1e-6) << "east is left";
    EXPECT_FALSE(place_of(g, {263.8, 5.4})) << "behind";
    for (const glm::dvec2 sky : {glm::dvec2(0.0, 89.9), {359.9, 0.0}, {120.0, -70.0}}) {
        const TanGrid turned = grid({10.0, 300.0}, sky, 0.002, 33.0);
        const std::optional<glm::dvec2> back = place_of(turned, sky_at(turned, {417.3, -20.6}));
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x, 417.3, 1e-7);
        EXPECT_NEAR(back->y, -20.6, 1e-7);
    }
}

// Dots painted at places of the sky are found within .3 px of where the other grid has these places.
TEST(SkyGrid, PicturesOfOtherScaleAndAngleMeet) {
    const TanGrid target = grid({100.5, 80.5}, {202.47, 47.2}, 0.0012, 0.0);
    for (const double factor : {3.0, 1.0, 1.0 / 3.0}) {
        const TanGrid own = grid({260.0, 240.0}, {202.5, 47.18}, 0.0012 * factor, 37.0);
        const std::vector<glm::dvec2> places{{60.2, 50.7}, {100.5, 80.5}, {140.8, 111.3}, {60.6, 120.1}};
        const Image image = painted(520, 480, 1, [&](double x, double y, int) {
            double sum = 0.0;
            for (const glm::dvec2& place : places) {
                const glm::dvec2 at = *place_of(own, sky_at(target, place));
                const double dx = x + 0.5 - at.x, dy = 480.0 + 0.5 - y - at.y;
                const double sigma = std::max(1.2, 2.0 / factor);
                sum += std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma));
            }
            return sum;
        });
        PixelMask outside;
        const Image seen = regridded(image, own, target, 200, 160, outside);
        for (const glm::dvec2& place : places) {
            double sum = 0.0, x = 0.0, y = 0.0;
            const double left = place.x - 0.5, top = 160.0 + 0.5 - place.y;
            for (std::int64_t j = 0; j < 160; ++j)
                for (std::int64_t i = 0; i < 200; ++i) {
                    const double u = static_cast<double>(i) + 0.5, v = static_cast<double>(j) + 0.5;
                    if (std::hypot(u - left, v - top) > 12.0 || outside.at(i, j)) continue;
                    const auto light = static_cast<double>(*seen.at(i, j));
                    sum += light;
                    x += light * u;
                    y += light * v;
                }
            EXPECT_LT(std::hypot(x / sum - left, y / sum - top), 0.05) << factor << " " << place.x;
        }
        EXPECT_EQ(outside.at(0, 0), factor < 1.0) << factor;
        EXPECT_FALSE(outside.at(100, 80));
    }
}

}  // namespace
}  // namespace astrosplat
