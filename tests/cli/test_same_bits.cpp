// A frame is a pure function of scene and frame number: threads, instruction sets, the C library's choices,
// locale, frame range, order and region change no bit of its float pixels.
#include <algorithm>
#include <cstring>

#include "core/parallel.h"
#include "scene_fixture.h"
#include "source/texture.h"

namespace astrosplat::test {
namespace {

class SameBits : public SceneTest {
  protected:
    SameBits() {
        write_text(folder / "picture.ppm", small_picture());
        write_text(folder / "scene.toml", R"(astrosplat = 1
[output]
resolution = [97, 61]
frames = "1-3"
path = "frames/shot.####.exr"
depth = "float"
[[layer]]
name = "nebula"
[layer.source]
meshes = [ { mesh = "plane", texture = "picture.ppm" } ]
count = 10000
[layer.look]
density = 0.8
noise = { frequency = 0.7, cull = 0.4, silhouette = 0.3, jitter = 0.05, alpha = 0.2, brightness = 0.3 }
pdf = { shape = "gaussian" }
vertical = { shape = "exponential" }
grade = { gain = 1.5, saturation = 1.3, gamma = 1.1 }
[layer.render]
falloff = "exponential"
blend = "hybrid"
lod = { max_px = 24.0, max_children = 64 }
[[layer]]
name = "stars"
[layer.source]
kind = "splats"
file = "stars.pda"
[layer.render]
blend = "add"
[layer.transform]
rotate = [10.0, 20.0, 30.0]
[animation]
"layer.stars.transform.rotate" = { keys = [[1, [0, 0, 0]], [3, [20, 40, 60]]], interpolation = "smooth" }
)");
    }
};

TEST_F(SameBits, AnyNumberOfThreads) {
    const std::vector<std::string> expected = hashes({"-t", "1"});
    ASSERT_EQ(expected.size(), 3u);
    EXPECT_NE(expected[0], expected[1]) << "the frames must differ for this test to say anything";
    for (const char* threads : {"2", "3", "7"}) EXPECT_EQ(hashes({"-t", threads}), expected) << threads;
}

TEST_F(SameBits, WhateverVariantsTheCLibraryPicks) {
    RunOptions plain;
    plain.environment = {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA"};
    EXPECT_EQ(hashes({}, plain), hashes({}));
}

TEST_F(SameBits, AnyInstructionSet) {
    const std::vector<std::string> expected = hashes({});
    std::set<std::string> tried = {json("stats.json").at("vector_target")};
    for (const std::string& target : vector_targets()) {
        RunOptions options;
        options.environment = {"ASTROSPLAT_VECTOR_TARGET=" + target};
        EXPECT_EQ(hashes({"-v"}, options), expected) << target;
        EXPECT_EQ(json("stats.json").at("vector_target"), target) << "the target must really change";
        tried.insert(target);
    }
    EXPECT_EQ(tried.size(), vector_targets().size());
    EXPECT_GE(tried.size(), 2u) << "SSE2 and SSE4 at least, on any processor of the last fifteen years";
}

TEST_F(SameBits, TheInstructionSetInUseIsNamed) {
    RunOptions options;
    options.environment = {"ASTROSPLAT_VECTOR_TARGET=sse2"};
    const std::string said = batch({"-f", "1", "-v"}, options).err;
    EXPECT_NE(said.find("vector target sse2\n"), std::string::npos) << said;
}

TEST_F(SameBits, UnknownInstructionSetsAreRefusedWithTheChoices) {
    RunOptions options;
    options.environment = {"ASTROSPLAT_VECTOR_TARGET=mmx"};
    const RunResult result = batch({}, options);
    expect_one_line(result, 2, "ASTROSPLAT_VECTOR_TARGET: ");
    EXPECT_NE(result.err.find("'mmx'"), std::string::npos) << result.err;
    for (const std::string& target : vector_targets())
        EXPECT_NE(result.err.find(target), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(SameBits, AFrameAloneIsTheFrameInASequence) {
    const std::vector<std::string> expected = hashes({});
    ASSERT_EQ(expected.size(), 3u);
    EXPECT_EQ(hashes({"-f", "3"}), std::vector<std::string>{expected[2]});
    EXPECT_EQ(hashes({"-f", "1-3x2"}), (std::vector<std::string>{expected[0], expected[2]}));
}

TEST_F(SameBits, LittleMemory) { EXPECT_EQ(hashes({"--memory", "0.18"}), hashes({})); }

TEST_F(SameBits, AnyLocale) {
    RunOptions german;
    german.environment = {"LC_ALL=de_DE.UTF-8"};
    if (run_program({"/bin/sh", "-c", "locale -a | grep -qi '^de_DE.utf'"}).code != 0) {
        GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
    }
    EXPECT_EQ(hashes({}, german), hashes({}));
}

TEST_F(SameBits, ARegionIsACrop) {
    ASSERT_EQ(batch({"-f", "1", "-o", "whole.tif"}).code, 0);
    ASSERT_EQ(batch({"-f", "1", "-o", "part.tif", "--region", "13,7,41,29"}).code, 0);
    const Image whole = load_linear_image(folder / "whole.tif"),
                part = load_linear_image(folder / "part.tif");
    ASSERT_EQ(part.width, 41);
    ASSERT_EQ(part.height, 29);
    for (std::int64_t y = 0; y < part.height; ++y) {
        ASSERT_EQ(std::memcmp(part.at(0, y), whole.at(13, 7 + y), 41 * 4 * sizeof(float)), 0) << "row " << y;
    }
}

}  // namespace
}  // namespace astrosplat::test
