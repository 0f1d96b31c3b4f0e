// A frame is a function of scene and number, with a camera made elsewhere too.

#include <cstring>

#include "core/parallel.h"
#include "scene_fixture.h"
#include "source/texture.h"

namespace astrosplat::test {
namespace {

// A frame is a pure function of scene and frame number: threads, instruction sets, the C library's choices,
// locale, frame range, order and region change no bit of its float pixels.

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
    const Words expected = hashes({"-t", "1"});
    ASSERT_EQ(expected.size(), 3u);
    EXPECT_NE(expected[0], expected[1]) << "the frames must differ for this test to say anything";
    for (const char* threads : {"2", "3", "7"}) EXPECT_EQ(hashes({"-t", threads}), expected) << threads;
}

TEST_F(SameBits, WhateverVariantsTheCLibraryPicks) {
    EXPECT_EQ(hashes({}, {.environment = {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA"}}), hashes({}));
}

TEST_F(SameBits, AnyInstructionSet) {
    const Words expected = hashes({});
    std::set<std::string> tried = {json("stats.json").at("vector_target")};
    for (const std::string& target : vector_targets()) {
        EXPECT_EQ(hashes({"-v"}, {.environment = {"ASTROSPLAT_VECTOR_TARGET=" + target}}), expected)
            << target;
        EXPECT_EQ(json("stats.json").at("vector_target"), target) << "the target must really change";
        tried.insert(target);
    }
    EXPECT_EQ(tried.size(), vector_targets().size());
    EXPECT_GE(tried.size(), 2u) << "SSE2 and SSE4 at least, on any processor of the last fifteen years";
}

// Without a card Mesa's llvmpipe stands for one, which only --device gpu chooses.
TEST_F(SameBits, AnyDevice) {
    const RunResult device = expect_success(run({"device", "--device", "gpu", "--json", "--no-cache"}));
    const nlohmann::json found = nlohmann::json::parse(device.out);
    if (found.contains("problem")) GTEST_SKIP() << found.at("problem");
    EXPECT_EQ(found.at("same_bits"), true);
    const Words expected = hashes({"--device", "cpu"});
    EXPECT_EQ(json("stats.json").at("frames").at(0).at("device"), "cpu");
    EXPECT_EQ(hashes({"--device", "gpu"}), expected);
    EXPECT_EQ(json("stats.json").at("frames").at(0).at("device"), found.at("draws"));
    EXPECT_EQ(hashes({"--device", "gpu", "--region", "11,7,60,41"}),
              hashes({"--device", "cpu", "--region", "11,7,60,41"}));
    const std::pair<const char*, const char*> kinds[] = {
        {"camera.shutter=180", "camera.f_number=2.8"},
        {"camera.projection=orthographic", "layer.nebula.render.isolate=true"}};
    for (const auto& [one, other] : kinds) {
        const Words words = {"-f",      "1", "--set", one, "--set", other, "--set", "output.samples=4",
                             "--device"};
        EXPECT_EQ(hashes(joined(words, {"gpu"})), hashes(joined(words, {"cpu"}))) << one;
    }
    expect_one_line(batch({"--device", "gpu", "--overwrite", "-q", "--set", "camera.projection=fisheye"}), 2,
                    "it draws no projections onto the sphere");
    expect_one_line(batch({"--device", "tpu"}), 2, "--device: expected gpu, cpu or auto");
}

TEST_F(SameBits, TheInstructionSetInUseIsNamed) {
    const std::string said = batch({"-f", "1", "-v"}, {.environment = {"ASTROSPLAT_VECTOR_TARGET=sse2"}}).err;
    EXPECT_HAS(said, "vector target sse2\n");
}

TEST_F(SameBits, UnknownInstructionSetsAreRefusedWithTheChoices) {
    const RunResult result = batch({}, {.environment = {"ASTROSPLAT_VECTOR_TARGET=mmx"}});
    expect_one_line(result, 2, "ASTROSPLAT_VECTOR_TARGET: ");
    EXPECT_HAS(result.err, "'mmx'");
    for (const std::string& target : vector_targets()) EXPECT_HAS(result.err, target);
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(SameBits, AFrameAloneIsTheFrameInASequence) {
    const Words expected = hashes({});
    ASSERT_EQ(expected.size(), 3u);
    EXPECT_EQ(hashes({"-f", "3"}), Words{expected[2]});
    EXPECT_EQ(hashes({"-f", "1-3x2"}), (Words{expected[0], expected[2]}));
}

TEST_F(SameBits, LittleMemory) { EXPECT_EQ(hashes({"--memory", "0.18"}), hashes({})); }

TEST_F(SameBits, AnyLocale) {
    if (run_program({"/bin/sh", "-c", "locale -a | grep -qi '^de_DE.utf'"}).code != 0) {
        GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
    }
    EXPECT_EQ(hashes({}, {.environment = {"LC_ALL=de_DE.UTF-8"}}), hashes({}));
}

TEST_F(SameBits, ARegionIsACrop) {
    expect_success(batch({"-f", "1", "-o", "whole.tif"}));
    expect_success(batch({"-f", "1", "-o", "part.tif", "--region", "13,7,41,29"}));
    const Image whole = load_linear_image(folder / "whole.tif"),
                part = load_linear_image(folder / "part.tif");
    ASSERT_EQ(part.width, 41);
    ASSERT_EQ(part.height, 29);
    for (std::int64_t y = 0; y < part.height; ++y) {
        ASSERT_EQ(std::memcmp(part.at(0, y), whole.at(13, 7 + y), 41 * 4 * sizeof(float)), 0) << "row " << y;
    }
}

// A camera made elsewhere drives the frames of --batch: the same bits as its keyframes would, any number of
// frames, in any locale.

class CameraFileBatch : public SceneTest {
  protected:
    /// scene.toml with this [camera] and nothing else that moves.
    void write_still(const std::string& camera, const std::string& more = "") {
        write_scene();
        std::string text = text_of(folder / "scene.toml");
        text.erase(text.find("[animation]"));
        const std::string placed = "position = [0.0, 0.0, 9.0]\n";
        text.replace(text.find(placed), placed.size(), camera);
        write_text(folder / "scene.toml", text + more);
    }
};

const char* const three_lines =
    "1 0 0 9 0 0 0 40\n"
    "2 0.5 -0.25 8 0 0 0 42.5\n"
    "3 1.5 0.25 7.5 0 0 0 50\n";

TEST_F(CameraFileBatch, GivesTheBitsOfItsKeyframes) {
    write_text(folder / "cam.chan", three_lines);
    write_still("file = \"cam.chan\"\n");
    const Words imported = hashes({});
    EXPECT_EQ(hashes({}, {.environment = {"LC_ALL=de_DE.UTF-8"}}), imported);
    EXPECT_EQ(hashes({"-f", "3,2"}), (Words{imported[1], imported[2]}));
    write_text(folder / "cam.csv",
               "frame,camera.position.x,camera.position.y,camera.position.z,camera.fov\n"
               "1,0,0,9,40\n2,0.5,-0.25,8,42.5\n3,1.5,0.25,7.5,50\n");
    write_still("file = \"cam.csv\"\nrotation = [0.0, 0.0, 0.0, 1.0]\n");
    EXPECT_EQ(hashes({}), imported);
    write_still(
        "rotation = [0.0, 0.0, 0.0, 1.0]\n",
        "[animation]\n"
        "\"camera.position\" = { keys = [[1, [0, 0, 9]], [2, [0.5, -0.25, 8]], [3, [1.5, 0.25, 7.5]]] }\n"
        "\"camera.fov\" = { keys = [[1, 40], [2, 42.5], [3, 50]] }\n");
    EXPECT_EQ(hashes({}), imported);
    EXPECT_NE(imported[0], imported[1]);
}

TEST_F(CameraFileBatch, AskingForNFramesGivesNFrames) {
    write_text(folder / "cam.chan", three_lines);
    write_still("file = \"cam.chan\"\n");
    const Words all = hashes({"-f", "-1-7"});
    ASSERT_EQ(all.size(), 9u);
    EXPECT_EQ(all[0], all[2]) << "holds before the first";
    EXPECT_EQ(all[8], all[4]) << "and after the last";
    EXPECT_NE(all[3], all[4]);
}

TEST_F(CameraFileBatch, ResumeRendersOnlyWhatTheFileMoved) {
    write_text(folder / "cam.chan", three_lines);
    write_still("file = \"cam.chan\"\n");
    expect_success(batch());
    std::string moved = three_lines;
    moved.replace(moved.find("1.5"), 3, "2.5");
    write_text(folder / "cam.chan", moved);
    const RunResult again = expect_success(batch({"--resume", "--overwrite", "--progress", "plain"}));
    EXPECT_EQ(again.err.find("saved frames/shot.0002.exr"), std::string::npos) << again.err;
    EXPECT_HAS(again.err, "shot.0003.exr");
}

TEST_F(CameraFileBatch, TheSceneGivesItsCameraAway) {
    const RunResult written = expect_success(run({"camera", "scene.toml", "-o", "out ö.csv", "-f", "1-5"}));
    EXPECT_EQ(written.out, "out ö.csv: 5 frames\n");
    EXPECT_EQ(line_count(text_of(folder / "out ö.csv")), 6);
    expect_one_line(run({"camera", "scene.toml", "-o", "out ö.csv"}), 2, "exists already");
    expect_one_line(run({"camera", "scene.toml", "-o", "out.abc"}), 2, ".chan, .csv, .gltf or .usda");
    const std::string before = text_of(folder / "out ö.csv");
    expect_success(run({"camera", "scene.toml", "-o", "out ö.csv", "-f", "1-5", "--overwrite"},
                       {.environment = {"LC_ALL=de_DE.UTF-8"}}));
    EXPECT_EQ(text_of(folder / "out ö.csv"), before);
}

TEST_F(CameraFileBatch, OddFilesEndInOneLine) {
    write_still("file = \"cam.chan\"\n");
    expect_one_line(batch(), 2,
                    "scene.toml:7: camera.file: cam.chan: cannot be read: No such file or directory");
    write_text(folder / "cam.chan", "1 0 0 9 0 0 0\n2 0 x 9 0 0 0\n");
    expect_one_line(batch(), 2, "cam.chan:2: expected a number for ty, found 'x'");
    fs::create_directory(folder / "dir.chan");
    write_still("file = \"dir.chan\"\n");
    expect_one_line(batch(), 2, "dir.chan: cannot be read: ");
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

}  // namespace
}  // namespace astrosplat::test
