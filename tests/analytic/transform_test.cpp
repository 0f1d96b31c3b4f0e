// Finished splats: through a plain look, and moved by their layer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analytic/support.h"
#include "core/real.h"
#include "output/compare.h"
#include "output/write.h"

namespace astrosplat {
namespace {

// A layer's transform acts on finished splats: it moves, turns and scales them, radii included, without
// touching the set; and it is double precision, so that small things far out keep their place.

using namespace astrosplat::analytic;

/// Seen along -z from far away, 10 px per scene unit, the origin in the middle of 80 x 80 px.
std::string one_splat_scene(const std::string& transform) {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [80, 80]
[camera]
projection = "orthographic"
position = [0, 0, 20]
height = 8.0
[[layer]]
name = "one"
[layer.transform]
{}
[layer.source]
kind = "splats"
file = "one.pda"
[layer.render]
blend = "add"
falloff = "constant"
)",
                       transform);
}

/// Light of the picture, and its centre of gravity in scene units.
struct Blob {
    double light, x, y;
};
Blob blob_of(const Image& image) {
    Blob blob{0.0, 0.0, 0.0};
    for (std::int64_t y = 0; y < image.height; ++y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            const double light = image.at(x, y)[0];
            blob.light += light;
            blob.x += light * (static_cast<double>(x) + 0.5 - 40.0) / 10.0;
            blob.y += light * (40.0 - static_cast<double>(y) - 0.5) / 10.0;
        }
    }
    blob.x /= blob.light;
    blob.y /= blob.light;
    return blob;
}

struct Expected {
    const char* transform;
    double scale, x, y;
};

// The splat lies at (1, 0.5, 2); (x, y) is where it is seen afterwards.
TEST(Transform, ScalesTurnsAboutXThenYThenZAndMoves) {
    const TempFolder folder;
    folder.file(
        "one.pda",
        "ATTRIBUTES\nposition rgbPP opacityPP radiusPP\nTYPES\nV V R R\nNUMBER_OF_PARTICLES: 1\nBEGIN "
        "DATA\n1 0.5 2 1 1 1 0.5 0.6\n");
    const Expected cases[] = {
        {"", 1.0, 1.0, 0.5},
        {"translate = [-2, 1, 5]", 1.0, -1.0, 1.5},
        {"scale = 1.5", 1.5, 1.5, 0.75},
        {"rotate = [90, 0, 0]", 1.0, 1.0, -2.0},
        {"rotate = [0, 90, 0]", 1.0, 2.0, 0.5},
        {"rotate = [0, 0, 90]", 1.0, -0.5, 1.0},
        {"rotate = [90, 0, 90]", 1.0, 2.0, 1.0},
        {"rotate = [90, 90, 0]", 1.0, 0.5, -2.0},
        {"translate = [0.5, 0, 0]\nrotate = [0, 0, 90]\nscale = 0.5", 0.5, 0.25, 0.5},
    };
    for (const Expected& expected : cases) {
        const Blob blob = blob_of(render_text(folder, one_splat_scene(expected.transform)).beauty);
        const double radius_px = 6.0 * expected.scale;
        const double light = 0.5 * real::pi * radius_px * radius_px;
        EXPECT_NEAR(blob.x, expected.x, 2e-3) << expected.transform;
        EXPECT_NEAR(blob.y, expected.y, 2e-3) << expected.transform;
        EXPECT_NEAR(blob.light / light, 1.0, 0.005) << expected.transform;
    }
}

void write_texture(const TempFolder& folder) {
    write_float_tiff(folder / "cloud.tif", 16, 16, [](int x, int y) {
        return glm::vec4(0.2 + x / 20.0, 0.9 - y / 20.0, 0.5, (x * 7 + y * 5) % 11 / 11.0);
    });
}

std::string cloud_scene(const glm::dvec3& place, const std::string& animation = "") {
    const glm::dvec3 eye = place + glm::dvec3(2.5, 6.25, 7.5);
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [96, 72]
[camera]
position = [{}, {}, {}]
target = [{}, {}, {}]
[[layer]]
name = "cloud"
[layer.transform]
translate = [{}, {}, {}]
rotate = [10, 20, 30]
scale = 0.75
[layer.source]
meshes = [ {{ mesh = "plane", texture = "cloud.tif" }} ]
count = 20000
)",
                       eye.x, eye.y, eye.z, place.x, place.y, place.z, place.x, place.y, place.z) +
           animation;
}

TEST(Transform, KeepsThePlaceOfANebulaInsideAGalaxy) {
    const TempFolder folder;
    write_texture(folder);
    const Image here = render_text(folder, cloud_scene(glm::dvec3(0.0))).beauty;
    const Image far_out = render_text(folder, cloud_scene({1e6, -2e6, 3e6})).beauty;
    EXPECT_GT(mean(here).a, 0.1);
    // All numbers of both scenes are whole multiples of 1/4, so nothing is rounded and nothing may differ.
    EXPECT_EQ(pixel_hash(far_out), pixel_hash(here));
    // Elsewhere the doubles themselves round: by 1e-9 scene units, of which a pixel has 0.1.
    const Image odd = render_text(folder, cloud_scene({1234567.1, -2345678.3, 3456789.7})).beauty;
    EXPECT_GT(compare_images(odd, here).psnr_db, 60.0);
}

TEST(Transform, NeverRegeneratesNorAppliesTheLookAgain) {
    const TempFolder folder;
    write_texture(folder);
    Pipeline pipeline(scene_of(folder, cloud_scene(glm::dvec3(0.0), R"([animation]
"layer.cloud.transform.rotate" = { keys = [[1, [0, 0, 0]], [3, [0, 90, 0]]] }
"layer.cloud.transform.scale" = { keys = [[1, 1.0], [3, 2.0]] }
)")));
    const std::string first = pixel_hash(render_frame(pipeline, 1.0).beauty);
    const LayerStatistics before = pipeline.statistics()[0];
    EXPECT_NE(pixel_hash(render_frame(pipeline, 2.0).beauty), first);
    const LayerStatistics after = pipeline.statistics()[0];
    EXPECT_EQ(after.kept, before.kept);
    EXPECT_EQ(after.generate_seconds, before.generate_seconds);
    EXPECT_EQ(after.look_seconds, before.look_seconds);
}

// A splat file under a look at its defaults passes through unchanged: the pixels follow from the numbers in
// the file alone.

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
