// Holes: what Laplace's equation knows in closed form, and texture that goes on.
#include "prepare/fill.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/prepare/painted.h"

namespace astrosplat {
namespace {

PixelMask disc(std::int64_t width, std::int64_t height, double x, double y, double radius) {
    PixelMask mask = make_mask(width, height);
    for (std::int64_t j = 0; j < height; ++j)
        for (std::int64_t i = 0; i < width; ++i)
            mask.at(i, j) =
                std::hypot(static_cast<double>(i) + 0.5 - x, static_cast<double>(j) + 0.5 - y) < radius;
    return mask;
}

// Two harmonic functions: a plane, and a saddle.
Image harmonic(std::int64_t size) {
    return painted(size, size, 2, [&](double x, double y, int c) {
        const double u = x / static_cast<double>(size) - 0.5, v = y / static_cast<double>(size) - 0.5;
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
                const double d = image.at(x, y)[1] - (0.5 + (static_cast<double>(x) + 0.5) / 640.0);
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

}  // namespace
}  // namespace astrosplat
