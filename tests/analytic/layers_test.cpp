// Layers and frames: what they add up to, and what a track changes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "analytic/support.h"
#include "output/write.h"

namespace astrosplat {
namespace {

// Layers and environment in a written EXR: the light of all layers as it arrives, plus the environment's, is
// the beauty; and the file holds the channels that were asked for, under their names and types.

using namespace astrosplat::analytic;

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
    for (int y = 0; y < size_px; ++y) {
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
    folder.file(
        "one.pda",
        "ATTRIBUTES\nposition rgbPP opacityPP radiusPP\nTYPES\nV V R R\nNUMBER_OF_PARTICLES: 1\nBEGIN "
        "DATA\n0 0 -2.5 1 1 1 0.25 3\n");
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
