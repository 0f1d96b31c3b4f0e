// --batch: which files appear, what is said where, and what the figures hold.
#include <regex>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Batch : public SceneTest {};

const std::set<std::string> three_frames = {"shot.0001.exr", "shot.0002.exr", "shot.0003.exr"};

TEST_F(Batch, RendersEveryFrameAndSaysSo) {
    const RunResult result = batch();
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(names_in("frames"), three_frames);
    EXPECT_TRUE(std::regex_search(
        result.err,
        std::regex("astrosplat: frame 2 \\(2/3\\) [0-9]+% eta ([0-9]{2}|--):([0-9]{2}|--):([0-9]{2}|--)\n")))
        << result.err;
    EXPECT_TRUE(std::regex_search(result.err, std::regex("saved .*shot\\.0003\\.exr [0-9]+\\.[0-9]{2}s\n")))
        << result.err;
}

TEST_F(Batch, QuietSaysNothing) {
    EXPECT_EQ(batch({"-q"}).err, "");
    const RunResult plain = batch({"-q", "--progress", "plain", "--overwrite"});
    EXPECT_NE(plain.err.find("saved "), std::string::npos);
}

TEST_F(Batch, OptionsComeInAnyOrder) {
    EXPECT_EQ(run({"-f", "2", "scene.toml", "-t", "1", "--batch", "-q"}).code, 0);
    EXPECT_EQ(names_in("frames"), std::set<std::string>{"shot.0002.exr"});
}

TEST_F(Batch, FramesAreThoseAskedFor) {
    EXPECT_EQ(batch({"--frames", "-2-0,5-9x2", "-o", "a/f%02d.png"}).code, 0);
    EXPECT_EQ(names_in("a"),
              (std::set<std::string>{"f-02.png", "f-01.png", "f00.png", "f05.png", "f07.png", "f09.png"}));
    EXPECT_EQ(batch({"-f", "12", "-o", "b/{frame:03}.tif"}).code, 0);
    EXPECT_EQ(names_in("b"), std::set<std::string>{"012.tif"});
}

TEST_F(Batch, PathsOfTheSceneStartAtItsFolderThoseOfTheCommandLineHere) {
    fs::create_directories(folder / "elsewhere");
    RunOptions elsewhere;
    elsewhere.folder = folder / "elsewhere";
    EXPECT_EQ(run({"--batch", "../scene.toml", "-f", "1"}, elsewhere).code, 0);
    EXPECT_TRUE(fs::exists(folder / "frames/shot.0001.exr"));
    EXPECT_EQ(run({"--batch", "../scene.toml", "-f", "1", "-o", "here.exr"}, elsewhere).code, 0);
    EXPECT_TRUE(fs::exists(folder / "elsewhere/here.exr"));
    EXPECT_EQ(run({"--batch", "../scene.toml", "-f", "1", "--set", "output.path=set.exr"}, elsewhere).code,
              0);
    EXPECT_TRUE(fs::exists(folder / "elsewhere/set.exr"));
}

TEST_F(Batch, PathsMayHoldSpacesAndUmlauts) {
    const fs::path odd = folder / "Große Nebel ☆";
    fs::create_directories(odd);
    for (const char* name : {"scene.toml", "stars.pda", "dust.pda"}) fs::copy(folder / name, odd / name);
    RunOptions here;
    here.folder = odd;
    EXPECT_EQ(
        run({"--batch", (odd / "scene.toml").string(), "-f", "1", "-o", "Bilder/ä ö.####.exr"}, here).code,
        0);
    EXPECT_TRUE(fs::exists(odd / "Bilder/ä ö.0001.exr"));
}

TEST_F(Batch, NeedsNoDisplay) {
    RunOptions bare;
    bare.without = {"DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR", "HOME", "LANG"};
    EXPECT_EQ(batch({"-f", "1"}, bare).code, 0);
}

TEST_F(Batch, DryRunTellsAndWritesNothing) {
    const RunResult result = batch({"--dry-run", "--stats", "stats.json"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("3 to render"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("shot.0003.exr"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("memory about"), std::string::npos) << result.out;
    EXPECT_EQ(names_in("."), (std::set<std::string>{"scene.toml", "stars.pda", "dust.pda"}));
}

TEST_F(Batch, StatsHoldTheKeysOfTheContract) {
    ASSERT_EQ(batch({"--stats", "figures/stats.json", "-t", "2"}).code, 0);
    const nlohmann::json stats = json("figures/stats.json");
    ASSERT_EQ(stats.at("frames").size(), 3u);
    for (const char* key :
         {"frame", "file", "seconds", "render_seconds", "splats_in", "splats_drawn", "sha256"}) {
        EXPECT_TRUE(stats.at("frames")[0].contains(key)) << key;
    }
    ASSERT_EQ(stats.at("layers").size(), 2u);
    for (const char* key : {"name", "test_positions", "kept", "zero_alpha", "drawn", "generate_seconds",
                            "look_seconds", "cached"}) {
        EXPECT_TRUE(stats.at("layers")[0].contains(key)) << key;
    }
    EXPECT_EQ(stats.at("layers")[1].at("name"), "dust");
    EXPECT_EQ(stats.at("layers")[1].at("kept"), 100);
    EXPECT_EQ(stats.at("frames")[2].at("frame"), 3);
    EXPECT_EQ(stats.at("frames")[0].at("splats_in"), 400);
    EXPECT_EQ(stats.at("frames")[0].at("sha256").get<std::string>().size(), 64u);
    EXPECT_EQ(stats.at("threads"), 2);
    EXPECT_GT(stats.at("peak_memory_bytes"), 1000000);
    EXPECT_TRUE(stats.contains("seconds") && stats.contains("version"));
}

TEST_F(Batch, LayersChooseWhatIsDrawn) {
    ASSERT_EQ(batch({"-f", "1", "--layers", "dust", "--stats", "stats.json"}).code, 0);
    EXPECT_EQ(json("stats.json").at("frames")[0].at("splats_in"), 100);
    EXPECT_EQ(json("stats.json").at("layers")[0].at("kept"), 0) << "a layer that is not drawn is not loaded";
}

TEST_F(Batch, ResolutionIsASizeOrAShare) {
    for (const auto& [text, size] : {std::pair{"50%", "32"}, std::pair{"40x30", "40"}}) {
        ASSERT_EQ(batch({"-f", "1", "--resolution", text, "-o", "p.png", "--overwrite"}).code, 0);
        const nlohmann::json info = nlohmann::json::parse(run({"info", "p.png", "--json"}).out);
        EXPECT_EQ(info.at("width").dump(), size);
    }
}

TEST_F(Batch, RefusesToOverwrite) {
    ASSERT_EQ(batch({"-f", "2"}).code, 0);
    const std::string before = text_of(folder / "frames/shot.0002.exr");
    const RunResult result = batch({"--set", "output.exposure=1"});
    expect_one_line(result, 2, "shot.0002.exr");
    EXPECT_EQ(names_in("frames").size(), 1u);
    EXPECT_EQ(text_of(folder / "frames/shot.0002.exr"), before);
    EXPECT_EQ(batch({"--overwrite"}).code, 0);
    EXPECT_EQ(names_in("frames"), three_frames);
}

TEST_F(Batch, AFrameThatFailsSparesTheOthers) {
    write_text(folder / "frames/shot.0002.exr/in-the-way", "");
    const RunResult result = batch({"--overwrite", "--stats", "stats.json"});
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_TRUE(std::regex_search(last_line(result.err), std::regex("failed: 2$"))) << result.err;
    EXPECT_EQ(names_in("frames"), three_frames);
    EXPECT_TRUE(fs::is_regular_file(folder / "frames/shot.0003.exr"));
    EXPECT_EQ(json("stats.json").at("frames").size(), 2u);
    EXPECT_EQ(json("stats.json").at("failed")[0].at("frame"), 2);
}

TEST_F(Batch, OutputThatCannotBeWrittenIsCode4BeforeAnyWork) {
    write_text(folder / "file", "");
    for (const char* output : {"file/shot.####.exr", "/proc/astrosplat/shot.####.exr"}) {
        const RunResult result = batch({"-o", output});
        EXPECT_EQ(result.code, 4) << result.err;
        EXPECT_EQ(line_count(result.err), 1) << result.err;
    }
    EXPECT_EQ(batch({"--stats", "file/stats.json"}).code, 4);
    EXPECT_FALSE(fs::exists(folder / "frames/shot.0001.exr"));
}

}  // namespace
}  // namespace astrosplat::test
