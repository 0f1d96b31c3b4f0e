// Finished splats moved by their layer, and what layers and frames add up to.
#include "analytic/support.h"
#include "output/compare.h"
#include "output/write.h"
#include "support/test.h"

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
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x) {
            const double light = image.at(x, y)[0];
            blob.light += light;
            blob.x += light * (double(x) + 0.5 - 40.0) / 10.0;
            blob.y += light * (40.0 - double(y) - 0.5) / 10.0;
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
    folder.file("one.pda", pda("1 0.5 2 1 1 1 0.5 0.6\n"));
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
constexpr const char* three_splats = R"(-2.5 2.5 0 0.5 0.25 1 1 2
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
    folder.file("three.pda", pda(three_splats));
    const StoredFile file =
        read_stored_file(write_text(folder, splat_scene("path = \"out.exr\"\ndepth = \"float\"")));
    const auto pixel = [&](int x, int y) {
        return glm::vec4(file.at("R", x, y), file.at("G", x, y), file.at("B", x, y), file.at("A", x, y));
    };
    const float margin = 2.0f;  // 4 * pixel_filter
    int inside = 0, overlap = 0, outside = 0;
    for (int y = 0; y < 64; ++y)
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
    EXPECT_GT(inside, 300);
    EXPECT_GT(overlap, 300);
    EXPECT_GT(outside, 1000);
}

TEST(SplatFile, OneOpaqueSplatWritesItsColourIntoHalfExrToo) {
    const TempFolder folder;
    folder.file("three.pda", pda(three_splats));
    const StoredFile file = read_stored_file(write_text(folder, splat_scene("path = \"out.exr\"")));
    EXPECT_EQ(file.types[0], "half");
    EXPECT_EQ(file.at("R", 16, 16), 0.5f);
    EXPECT_EQ(file.at("G", 16, 16), 0.25f);
    EXPECT_EQ(file.at("B", 16, 16), 1.0f);
    EXPECT_EQ(file.at("A", 16, 16), 1.0f);
}

// PNG holds straight alpha: premultiplied (0.125, 0.25, 0.375, 0.5) is colour (0.25, 0.5, 0.75)
// of alpha one half.
TEST(SplatFile, PremultipliedPixelSurvivesPng) {
    const TempFolder folder;
    folder.file("three.pda", pda("0 0 0 0.25 0.5 0.75 0.5 3\n"));
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

// Layers and environment in a written EXR: the light of all layers as it arrives, plus the environment's, is
// the beauty; and the file holds the channels that were asked for, under their names and types.

constexpr int size_px = 48;
constexpr const char* names[] = {"dust", "stars", "glow", "veil"};

/// Three mixed layers that share one sorted pass, an isolated one in front, the environment behind.
std::string layered_scene(double environment_gain, const char* depth) {
    std::string text = fmt::format(R"(astrosplat = 1
[output]
resolution = [{0}, {0}]
frames = "1"
path = "out.exr"
depth = "{1}"
aovs = ["depth", "coverage", "count", "layers"]
[camera]
position = [3, 6, 9]
fov = 50.0
[environment]
image = "sky.tif"
gain = {2}
)",
                                   size_px, depth, environment_gain);
    const char* renders[] = {"blend = \"over\"\nopacity = 0.7", "blend = \"add\"\nopacity = 0.2",
                             "blend = \"screen\"\nopacity = 0.5",
                             "blend = \"over\"\nisolate = true\nopacity = 0.3"};
    const char* turns[] = {"[0, 0, 0]", "[20, 0, 0]", "[0, 0, 30]", "[90, 0, 0]"};
    for (int i = 0; i < 4; ++i)
        text += fmt::format(R"([[layer]]
name = "{}"
[layer.transform]
rotate = {}
[layer.source]
meshes = [ {{ mesh = "plane", texture = "picture.tif" }} ]
count = 8000
[layer.render]
{}
)",
                            names[i], turns[i], renders[i]);
    return text;
}

void write_pictures(const TempFolder& folder) {
    write_float_tiff(folder / "picture.tif", 16, 16, [](int x, int y) {
        return glm::vec4(0.1 + x / 16.0, 0.9 - y / 20.0, 0.4, 0.3 + 0.04 * x);
    });
    write_float_tiff(folder / "sky.tif", 32, 16,
                     [](int x, int y) { return glm::vec4(0.2 + x / 64.0, 0.3, 0.1 + y / 32.0, 1.0); });
}

TEST(Layers, AndEnvironmentSumToTheBeauty) {
    const TempFolder folder;
    write_pictures(folder);
    const StoredFile once = read_stored_file(write_text(folder, layered_scene(1.0, "float")));
    const StoredFile twice = read_stored_file(write_text(folder, layered_scene(2.0, "float")));
    double most_environment = 0.0;
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) {
            EXPECT_EQ(once.at("A", x, y), 1.0f);
            for (const char* channel : {"R", "G", "B"}) {
                // The beauty is linear in the environment's light: its share is what doubling it adds.
                const float environment = twice.at(channel, x, y) - once.at(channel, x, y);
                float sum = environment;
                for (const char* name : names) sum += once.at(fmt::format("{}.{}", name, channel), x, y);
                EXPECT_NEAR(sum, once.at(channel, x, y), 2e-5f) << x << " " << y << " " << channel;
                most_environment = std::max(most_environment, double(environment));
            }
        }
    EXPECT_GT(most_environment, 0.2);
    for (const char* name : names) {  // every layer gives some light
        double light = 0.0;
        for (int y = 0; y < size_px; ++y)
            for (int x = 0; x < size_px; ++x) light += once.at(std::string(name) + ".G", x, y);
        EXPECT_GT(light / (size_px * size_px), 0.01) << name;
    }
}

TEST(Layers, ChannelsHaveTheirNamesAndTypes) {
    const TempFolder folder;
    write_pictures(folder);
    for (const std::string depth : {"half", "float"}) {
        const StoredFile file = read_stored_file(write_text(folder, layered_scene(1.0, depth.c_str())));
        std::vector<std::pair<std::string, std::string>> expected = {
            {"R", depth},   {"G", depth},        {"B", depth},       {"A", depth},
            {"Z", "float"}, {"coverage", depth}, {"count", "float"},
        };
        for (const char* name : names)
            for (const char* channel : {"R", "G", "B", "A"})
                expected.emplace_back(fmt::format("{}.{}", name, channel), depth);
        std::vector<std::pair<std::string, std::string>> found;
        for (std::size_t i = 0; i < file.names.size(); ++i) found.emplace_back(file.names[i], file.types[i]);
        std::sort(expected.begin(), expected.end());
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
    }
}

TEST(Layers, DepthCoverageAndCountOfOneSplat) {
    const TempFolder folder;
    folder.file("one.pda", pda("0 0 -2.5 1 1 1 0.25 3\n"));
    const StoredFile file = read_stored_file(write_text(folder, R"(astrosplat = 1
[output]
resolution = [48, 48]
frames = "1"
path = "out.exr"
depth = "float"
aovs = ["depth", "coverage", "count"]
[camera]
position = [0, 0, 10]
[[layer]]
name = "one"
[layer.source]
kind = "splats"
file = "one.pda"
[layer.render]
falloff = "constant"
)"));
    EXPECT_FLOAT_EQ(file.at("Z", 24, 24), 12.5f);
    EXPECT_EQ(file.at("A", 24, 24), 0.25f);
    EXPECT_EQ(file.at("coverage", 24, 24), 1.0f);
    EXPECT_EQ(file.at("count", 24, 24), 1.0f);
    for (const char* channel : {"Z", "coverage", "count"}) EXPECT_EQ(file.at(channel, 0, 0), 0.0f);
}

// Frames over time: a track changes the picture as its values say, and frame k is the same to the last bit
// alone, in a sequence, backwards, and twice.

std::string moving_scene(const char* blend, const char* animation) {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [80, 60]
[camera]
position = [2, 8, 9]
[[layer]]
name = "cloud"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "cloud.tif" }} ]
count = 20000
[layer.render]
blend = "{}"
[animation]
{}
)",
                       blend, animation);
}

constexpr const char* everything_moves = R"(
"camera.position" = { keys = [[1, [2, 8, 9]], [5, [-1, 2, 4]], [9, [-3, 1, 0.5]]], interpolation = "smooth" }
"layer.cloud.look.pdf.shape" = { keys = [[1, "constant"], [5, "gaussian"]] }
"layer.cloud.look.noise.jitter" = { keys = [[1, 0.0], [9, 0.5]] }
"layer.cloud.look.alpha.power" = { keys = [[1, 1.0], [4, 3.0], [6, 3.0]] }
"layer.cloud.render.falloff" = { keys = [[1, "trapezoid"], [7, "gaussian"]] }
"layer.cloud.render.core" = { keys = [[1, 1.0], [6, 0.5]] }
"layer.cloud.render.lod.max_px" = { keys = [[1, 300.0], [9, 600.0]] }
)";

void write_cloud(const TempFolder& folder) {
    write_float_tiff(folder / "cloud.tif", 16, 16, [](int x, int y) {
        return glm::vec4(0.2 + x / 20.0, 0.9 - y / 20.0, 0.5, 0.1 + (x * 7 + y * 5) % 11 / 14.0);
    });
}

TEST(Frames, OpacityTrackFadesTheLightAsItSays) {
    const TempFolder folder;
    write_cloud(folder);
    Pipeline pipeline(scene_of(
        folder, moving_scene("add", R"("layer.cloud.render.opacity" = { keys = [[1, 1.0], [9, 0.0]] })")));
    const Image full = render_frame(pipeline, 1.0).beauty;
    EXPECT_GT(mean(full).r, 0.05);
    const Image half = render_frame(pipeline, 5.0).beauty;  // opacity 1/2: every product is exactly halved
    const Image gone = render_frame(pipeline, 9.0).beauty;
    for (std::size_t i = 0; i < full.pixels.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha is held at 1
        ASSERT_EQ(half.pixels[i], 0.5f * full.pixels[i]) << i;
        ASSERT_EQ(gone.pixels[i], 0.0f) << i;
    }
}

TEST(Frames, GradeTracksChangeTheColourAsTheySay) {
    const TempFolder folder;
    write_cloud(folder);
    Pipeline pipeline(scene_of(
        folder, moving_scene("over", R"("layer.cloud.look.grade.gain" = { keys = [[1, 1.0], [3, 4.0]] }
"layer.cloud.look.grade.tint" = { keys = [[1, [1, 1, 1]], [3, [1, 0.5, 0]]] }
"layer.cloud.visible" = { keys = [[1, true], [4, false]] })")));
    const glm::dvec4 first = mean(render_frame(pipeline, 1.0).beauty);
    const glm::dvec4 second = mean(render_frame(pipeline, 2.0).beauty);  // gain 2.5, tint (1, 0.75, 0.5)
    EXPECT_NEAR(second.r / first.r, 2.5, 1e-4);
    EXPECT_NEAR(second.g / first.g, 1.875, 1e-4);
    EXPECT_NEAR(second.b / first.b, 1.25, 1e-4);
    EXPECT_NEAR(second.a / first.a, 1.0, 1e-4);
    EXPECT_EQ(mean(render_frame(pipeline, 4.0).beauty), glm::dvec4(0.0));
}

TEST(Frames, AloneInASequenceBackwardsAndTwiceAreTheSameBits) {
    const TempFolder folder;
    write_cloud(folder);
    const Scene scene = scene_of(folder, moving_scene("over", everything_moves));
    std::vector<std::string> alone;
    for (int frame = 1; frame <= 9; ++frame) {
        Pipeline fresh(scene);
        alone.push_back(pixel_hash(render_frame(fresh, frame).beauty));
    }
    for (std::size_t i = 1; i < alone.size(); ++i) EXPECT_NE(alone[i], alone[i - 1]);
    Pipeline pipeline(scene);
    for (int frame = 1; frame <= 9; ++frame)
        EXPECT_EQ(pixel_hash(render_frame(pipeline, frame).beauty), alone.at(frame - 1));
    for (int frame = 9; frame >= 1; frame -= 2)
        for (int again = 0; again < 2; ++again)
            EXPECT_EQ(pixel_hash(render_frame(pipeline, frame).beauty), alone.at(frame - 1)) << frame;
}

}  // namespace
}  // namespace astrosplat
