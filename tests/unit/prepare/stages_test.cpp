// Stages of prepare: sky, cuts, colours, holes and registration.
#include "prepare/stages.h"
#include "core/color.h"
#include "prepare/registration.h"
#include "support/tan_grid.h"
#include "support/test.h"
#include "unit/prepare/painted.h"

namespace astrosplat {
namespace {

// Sky, cuts, colours and grids: closed forms.

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
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) area += double(image.pixels[i]);
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
        for (std::size_t c = 0; c < 3; ++c) values[c] = real::linear_to_srgb(double(image.pixels[c]));
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

// Dots painted at places of the sky are found within .3 px of where the other grid has these places.
TEST(Regridded, PicturesOfOtherScaleAndAngleMeet) {
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
        const RowPlaces rows = [&](std::int64_t y, std::span<glm::dvec2> row) {
            for (std::size_t x = 0; x < row.size(); ++x) {
                const glm::dvec2 px = *place_of(own, sky_at(target, {double(x) + 1.0, double(160 - y)}));
                row[x] = {px.x - 0.5, 480.0 + 0.5 - px.y};
            }
        };
        const Image seen = regridded(image, rows, 1.0 / factor, 200, 160, outside);
        for (const glm::dvec2& place : places) {
            double sum = 0.0, x = 0.0, y = 0.0;
            const double left = place.x - 0.5, top = 160.0 + 0.5 - place.y;
            for (std::int64_t j = 0; j < 160; ++j)
                for (std::int64_t i = 0; i < 200; ++i) {
                    const double u = double(i) + 0.5, v = double(j) + 0.5;
                    if (std::hypot(u - left, v - top) > 12.0 || outside.at(i, j)) continue;
                    const auto light = double(*seen.at(i, j));
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

// Holes: what Laplace's equation knows in closed form, and texture that goes on.

PixelMask disc(std::int64_t width, std::int64_t height, double x, double y, double radius) {
    PixelMask mask = make_mask(width, height);
    for (std::int64_t j = 0; j < height; ++j)
        for (std::int64_t i = 0; i < width; ++i)
            mask.at(i, j) = std::hypot(double(i) + 0.5 - x, double(j) + 0.5 - y) < radius;
    return mask;
}

// Two harmonic functions: a plane, and a saddle.
Image harmonic(std::int64_t size) {
    return painted(size, size, 2, [&](double x, double y, int c) {
        const double u = x / double(size) - 0.5, v = y / double(size) - 0.5;
        return c == 0 ? 1.0 + 0.5 * u - 0.25 * v : 1.0 + u * u - v * v;
    });
}

TEST(Fill, MembraneContinuesWhatIsHarmonic) {
    for (const double radius : {1.0, 4.0, 20.0, 45.0}) {
        const Image truth = harmonic(128);
        const PixelMask holes = disc(128, 128, 66.0, 60.0, radius);
        Image image = truth;
        for (std::size_t i = 0; i < holes.pixels.size(); ++i)
            if (holes.pixels[i]) image.pixels[2 * i] = image.pixels[2 * i + 1] = NAN;
        fill(image, holes, FillKind::membrane);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            ASSERT_NEAR(image.pixels[i], truth.pixels[i], i % 2 ? 4e-3f : 2.5e-3f) << radius << " " << i;
    }
}

TEST(Fill, StaysWithinTheRim) {
    Image image = painted(64, 64, 1, [](double x, double, int) { return x < 32.0 ? 0.0 : 1.0; });
    const PixelMask holes = disc(64, 64, 32.0, 32.0, 15.0);
    fill(image, holes, FillKind::membrane);
    for (const float value : image.pixels) {
        EXPECT_GE(value, 0.0f);
        EXPECT_LE(value, 1.0f);
    }
    EXPECT_NEAR(*image.at(31, 32) + *image.at(32, 32), 1.0f, 0.05f) << "the middle of a symmetric rim";
}

TEST(Fill, TextureHasTheSpreadOfItsSurroundings) {
    const Image truth =
        add_noise(painted(160, 160, 3, [](double x, double, int) { return 0.5 + x / 640.0; }), 0.02, 7);
    const PixelMask holes = disc(160, 160, 80.0, 80.0, 16.0);
    const auto spread = [&](const Image& image) {  // of green about the slope
        double sum = 0.0, squares = 0.0, count = 0.0;
        for (std::int64_t y = 0; y < 160; ++y)
            for (std::int64_t x = 0; x < 160; ++x) {
                if (!holes.at(x, y)) continue;
                const double d = image.at(x, y)[1] - (0.5 + (double(x) + 0.5) / 640.0);
                sum += d;
                squares += d * d;
                count += 1.0;
            }
        return std::pair(sum / count, std::sqrt(squares / count));
    };
    Image smooth = truth, textured = truth;
    fill(smooth, holes, FillKind::membrane);
    fill(textured, holes, FillKind::texture);
    EXPECT_LT(spread(smooth).second, 0.012);
    EXPECT_NEAR(spread(textured).second, 0.02, 0.005);
    EXPECT_NEAR(spread(textured).first, 0.0, 0.005);
}

TEST(Fill, WritesNothingButTheHoles) {
    const Image before = add_noise(make_image(50, 40, 3, 0.5f), 0.1, 3);
    PixelMask holes = disc(50, 40, 10.0, 10.0, 5.0);
    holes.at(49, 39) = holes.at(0, 0) = 1;
    Image after = before;
    fill(after, holes, FillKind::texture);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < holes.pixels.size(); ++i) {
        const bool same = std::equal(&before.pixels[3 * i], &before.pixels[3 * i] + 3, &after.pixels[3 * i]);
        ASSERT_TRUE(same || holes.pixels[i]) << i;
        changed += same ? 0 : 1;
    }
    EXPECT_GT(changed, 75u);
}

TEST(Fill, PartsAreConnectedAtCornersToo) {
    PixelMask mask = make_mask(8, 6);
    mask.at(1, 1) = mask.at(2, 2) = mask.at(3, 1) = 1;
    mask.at(6, 5) = 1;
    const std::vector<PixelPart> parts = connected_parts(mask);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].pixels, (std::vector<std::int64_t>{9, 18, 11})) << "from the first one outwards";
    EXPECT_EQ(parts[0].box.width, 3);
    EXPECT_EQ(parts[0].box.height, 2);
    EXPECT_EQ(parts[1].box.x, 6);
}

TEST(Fill, APictureThatIsOneHoleBecomesZero) {
    Image image = make_image(5, 4, 3, 2.0f);
    PixelMask all = make_mask(5, 4);
    std::fill(all.pixels.begin(), all.pixels.end(), 1);
    fill(image, all, FillKind::texture);
    for (const float value : image.pixels) EXPECT_EQ(value, 0.0f);
}

// A painted picture is found again after it was moved, turned and scaled by known amounts.

/// Clouds of light at fixed places about (0, 0), reach about 1.5: no two parts are alike.
double clouds(double x, double y) {
    struct Cloud {
        double x, y, radius, light;
    };
    constexpr Cloud all[] = {{0.0, 0.0, 0.25, 0.7},   {0.5, 0.1, 0.12, 0.5},   {-0.3, 0.45, 0.2, 0.4},
                             {-0.6, -0.2, 0.08, 0.8}, {0.2, -0.55, 0.15, 0.5}, {0.8, 0.6, 0.1, 0.6},
                             {-0.9, 0.5, 0.12, 0.5},  {0.75, -0.5, 0.06, 0.9}, {-0.5, -0.75, 0.1, 0.4}};
    double light = 0.02;
    for (const Cloud& c : all)
        light += c.light *
                 real::exp(-((x - c.x) * (x - c.x) + (y - c.y) * (y - c.y)) / (2.0 * c.radius * c.radius));
    return light;
}

/// The clouds on width x height px: `place` says where a picture of 2 x 2 units, 200 px a side, lies.
Image clouds_on(std::int64_t width, std::int64_t height, const ImageOnImage& place) {
    Image image = make_image(width, height, 1);
    const double angle = real::radians(place.turn_deg), c = real::cos(angle), s = real::sin(angle);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const double dx = (double(x) + 0.5 - place.middle.x) / place.scale / 100.0;
            const double dy = (double(y) + 0.5 - place.middle.y) / place.scale / 100.0;
            *image.at(x, y) = float(clouds(c * dx - s * dy, s * dx + c * dy));
        }
    return image;
}

const Image cloud_picture = clouds_on(200, 200, {{100.0, 100.0}, 1.0, 0.0});

void expect_found(const Image& fixed, const Image& moving, const ImageOnImage& place,
                  const ImageOnImage& start) {
    const std::optional<Registration> found = registered(fixed, moving, start);
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(found->place.middle, place.middle), 1.0);
    EXPECT_NEAR(found->place.scale / place.scale, 1.0, 0.005);
    EXPECT_NEAR(std::remainder(found->place.turn_deg - place.turn_deg, 360.0), 0.0, 0.3);
    EXPECT_GT(found->likeness, 0.9);
}

TEST(Registration, FindsAKnownShiftTurnAndScale) {
    for (const ImageOnImage& place :
         {ImageOnImage{{160.0, 120.0}, 1.2, 0.0}, ImageOnImage{{200.0, 90.0}, 1.0, 35.0},
          ImageOnImage{{140.0, 150.0}, 0.7, -110.0}, ImageOnImage{{170.0, 110.0}, 1.7, 178.0}})
        expect_found(clouds_on(320, 240, place), cloud_picture, place, {{160.0, 120.0}, 1.2, 0.0});
}

TEST(Registration, AnotherContrastAndOffsetDoNotMatter) {
    const ImageOnImage place{{150.0, 110.0}, 1.1, -20.0};
    Image fixed = clouds_on(320, 240, place);
    for (float& value : fixed.pixels) value = 0.2f + 0.4f * value;
    expect_found(fixed, cloud_picture, place, {{160.0, 120.0}, 1.0, 0.0});
}

TEST(Registration, PartOfThePictureIsEnough) {
    const ImageOnImage place{{60.0, 190.0}, 1.4, 15.0};
    expect_found(clouds_on(320, 240, place), cloud_picture, place, {{160.0, 120.0}, 1.2, 0.0});
}

TEST(Registration, LargerPicturesAreFoundAsWell) {
    const ImageOnImage place{{800.0, 500.0}, 4.0, 50.0};
    expect_found(clouds_on(1600, 1000, place), cloud_picture, place, {{800.0, 500.0}, 5.0, 0.0});
}

TEST(Registration, WhatLiesRightStays) {
    const ImageOnImage place{{123.25, 130.5}, 1.0, 12.0};
    expect_found(clouds_on(320, 240, place), cloud_picture, place, place);
}

/// Any turn shows the same, which must not keep the shift and the scale from being found.
TEST(Registration, SomethingRoundIsFoundWithAnyTurn) {
    const auto blob = [](std::int64_t width, std::int64_t height, glm::dvec2 middle, double radius) {
        Image image = make_image(width, height, 1);
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) {
                const double r = glm::distance(glm::dvec2(double(x) + 0.5, double(y) + 0.5), middle) / radius;
                *image.at(x, y) = float(real::exp(-r * r) * (1.0 + 0.5 * real::cos(6.0 * r)));
            }
        return image;
    };
    const auto found = registered(blob(320, 240, {170.0, 110.0}, 40.0), blob(200, 200, {100.0, 100.0}, 40.0),
                                  {{160.0, 120.0}, 1.0, 33.0});
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(found->place.middle, glm::dvec2(170.0, 110.0)), 1.0);
    EXPECT_NEAR(found->place.scale, 1.0, 0.005);
}

Image noise(std::int64_t width, std::int64_t height, std::uint32_t seed) {
    Image image = make_image(width, height, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = float(shared::as_hash(seed, std::uint32_t(i), 0u, 1u)) / 4294967296.0f;
    return image;
}

TEST(Registration, WhereNothingMatchesThereIsNone) {
    const ImageOnImage start{{160.0, 120.0}, 1.0, 0.0};
    EXPECT_FALSE(registered(make_image(320, 240, 1), cloud_picture, start)) << "flat";
    EXPECT_FALSE(registered(clouds_on(320, 240, start), make_image(200, 200, 1, 0.5f), start)) << "flat";
    EXPECT_FALSE(registered(noise(320, 240, 1), noise(200, 200, 2), start));
    EXPECT_FALSE(registered(noise(320, 240, 1), cloud_picture, start));
}

}  // namespace
}  // namespace astrosplat
