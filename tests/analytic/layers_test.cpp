// Layers and environment in a written EXR: the light of all layers as it arrives, plus the environment's, is
// the beauty; and the file holds the channels that were asked for, under their names and types.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic/support.h"

namespace astrosplat {
namespace {

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

}  // namespace
}  // namespace astrosplat
