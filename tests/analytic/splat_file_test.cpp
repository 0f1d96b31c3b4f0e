// A splat file under a look at its defaults passes through unchanged: the pixels follow from the numbers in
// the file alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analytic/support.h"

namespace astrosplat {
namespace {

using namespace astrosplat::analytic;

// Perspective, 64 x 64 px, focal length 64 px (fov 2 atan(1/2)), eye at z = 10. In px: an opaque disc of
// radius 12.8 at (16, 16), a half transparent one of radius 12.8 at (42, 40) before an opaque one of
// radius 12.8 at the same place, twice as far and twice as large.
constexpr const char* three_splats = R"(ATTRIBUTES
position rgbPP opacityPP radiusPP
TYPES
V V R R
NUMBER_OF_PARTICLES: 3
BEGIN DATA
-2.5 2.5 0 0.5 0.25 1 1 2
1.5625 -1.25 0 0.25 0.5 0.75 0.5 2
3.125 -2.5 -10 1 0.5 0 1 4
)";

std::string splat_scene(const std::string& output) {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [64, 64]
frames = "1"
{}
[camera]
position = [0, 0, 10]
fov = 53.13010235415598
[[layer]]
name = "file"
[layer.source]
kind = "splats"
file = "three.pda"
[layer.render]
falloff = "constant"
)",
                       output);
}

/// Distance of a pixel's centre from a place of the picture, px.
double distance_px(int x, int y, double cx, double cy) {
    return std::sqrt((x + 0.5 - cx) * (x + 0.5 - cx) + (y + 0.5 - cy) * (y + 0.5 - cy));
}

TEST(SplatFile, PassesThroughUnchanged) {
    const TempFolder folder;
    folder.file("three.pda", three_splats);
    const StoredFile file =
        read_stored_file(write_text(folder, splat_scene("path = \"out.exr\"\ndepth = \"float\"")));
    const auto pixel = [&](int x, int y) {
        return glm::vec4(file.at("R", x, y), file.at("G", x, y), file.at("B", x, y), file.at("A", x, y));
    };
    const float margin = 2.0f;  // 4 * pixel_filter
    int inside = 0, overlap = 0, outside = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const double first = distance_px(x, y, 16.0, 16.0), pair = distance_px(x, y, 42.0, 40.0);
            if (first < 12.8 - margin) {
                ++inside;
                EXPECT_EQ(pixel(x, y), glm::vec4(0.5f, 0.25f, 1.0f, 1.0f)) << x << " " << y;
            } else if (pair < 12.8 - margin) {
                ++overlap;
                EXPECT_EQ(pixel(x, y), glm::vec4(0.625f, 0.5f, 0.375f, 1.0f)) << x << " " << y;
            } else if (first > 12.8 + margin && pair > 12.8 + margin) {
                ++outside;
                EXPECT_EQ(pixel(x, y), glm::vec4(0.0f)) << x << " " << y;
            }
        }
    }
    EXPECT_GT(inside, 300);
    EXPECT_GT(overlap, 300);
    EXPECT_GT(outside, 1000);
}

TEST(SplatFile, OneOpaqueSplatWritesItsColourIntoHalfExrToo) {
    const TempFolder folder;
    folder.file("three.pda", three_splats);
    const StoredFile file = read_stored_file(write_text(folder, splat_scene("path = \"out.exr\"")));
    EXPECT_EQ(file.types[0], "half");
    EXPECT_EQ(file.at("R", 16, 16), 0.5f);
    EXPECT_EQ(file.at("G", 16, 16), 0.25f);
    EXPECT_EQ(file.at("B", 16, 16), 1.0f);
    EXPECT_EQ(file.at("A", 16, 16), 1.0f);
}

// PNG holds straight alpha: premultiplied (0.125, 0.25, 0.375, 0.5) is colour (0.25, 0.5, 0.75) of alpha one
// half.
TEST(SplatFile, PremultipliedPixelSurvivesPng) {
    const TempFolder folder;
    folder.file("three.pda", R"(ATTRIBUTES
position rgbPP opacityPP radiusPP
TYPES
V V R R
NUMBER_OF_PARTICLES: 1
BEGIN DATA
0 0 0 0.25 0.5 0.75 0.5 3
)");
    const StoredFile file = read_stored_file(write_text(
        folder, splat_scene("path = \"out.png\"\ndepth = \"16\"\nalpha = \"straight\"\nview = \"linear\"")));
    ASSERT_EQ(file.image.channels, 4);
    const float unit = 1.0f / 65535.0f;
    EXPECT_NEAR(file.at("R", 32, 32), 0.25f, unit);
    EXPECT_NEAR(file.at("G", 32, 32), 0.5f, unit);
    EXPECT_NEAR(file.at("B", 32, 32), 0.75f, unit);
    EXPECT_NEAR(file.at("A", 32, 32), 0.5f, unit);
    // Across the soft rim the colour stays and only alpha falls.
    for (int x = 32; x < 64; ++x) {
        if (file.at("A", x, 32) < 0.02f) continue;
        EXPECT_NEAR(file.at("R", x, 32), 0.25f, 2.0f * unit) << x;
        EXPECT_NEAR(file.at("B", x, 32), 0.75f, 2.0f * unit) << x;
    }
}

}  // namespace
}  // namespace astrosplat
