// --memory bounds a run, and estimates say beforehand what it takes.
#include <fmt/format.h>

#include <map>
#include <sstream>

#include "scene_fixture.h"
#include "support/capture.h"

namespace astrosplat::test {
namespace {

// --memory bounds the whole program, and what a run announces is what it takes. Files that are larger than
// the memory are read block by block, for the same pixels.

class Memory : public SceneTest {
  protected:
    /// scene.toml draws a splat file; `more` belongs to its layer, or follows it.
    void make_scene_of(const std::string& file, const std::string& resolution, const std::string& position,
                       const std::string& more = "") const {
        write_text(folder / "scene.toml", fmt::format(R"(astrosplat = 1
[output]
resolution = {}
frames = "1"
path = "frames/shot.####.exr"
[camera]
position = {}
[[layer]]
name = "ball"
[layer.source]
kind = "splats"
file = "{}"
{}
)",
                                                      resolution, position, file, more));
    }

    /// A ball of so many splats in ball.splats, drawn by scene.toml.
    void make_ball(int splats, const std::string& resolution, const std::string& more = "") {
        write_text(folder / "ball.ppm", small_picture());
        write_text(folder / "mesh.toml", fmt::format(R"(astrosplat = 1
[[layer]]
name = "ball"
[layer.source]
meshes = [ {{ mesh = "sphere", texture = "ball.ppm" }} ]
splats = {}
)",
                                                     splats));
        expect_success(
            run({"generate", "mesh.toml", "--layer", "ball", "-o", "ball.splats", "-q", "--no-cache"}));
        make_scene_of("ball.splats", resolution, "[3.0, 6.0, 13.0]", more);
    }

    /// The same ball, which scene.toml generates, seen from a place; `more` belongs to its layer.
    void make_ball_to_generate(int splats, const std::string& position, const std::string& more = "") {
        make_ball(1000, "[64, 36]");
        std::string text = text_of(folder / "mesh.toml");
        text.replace(text.find("splats = 1000"), 13, fmt::format("splats = {}", splats));
        write_text(folder / "scene.toml", fmt::format(R"({}{}
[output]
resolution = [640, 360]
frames = "1"
path = "frames/shot.####.exr"
[camera]
position = {}
)",
                                                      text, more, position));
    }

    struct Run {
        std::string hash, err;
        double estimated_mib = 0.0, taken_mib = 0.0;
    };
    Run rendered(Words more, bool cached = false) const {
        more.insert(more.end(), {"--overwrite", "--stats", "stats.json"});
        if (!cached) more.push_back("--no-cache");
        const RunResult result = expect_success(batch(more));
        if (result.code != 0) return {};
        const nlohmann::json stats = json("stats.json");
        Run run{stats.at("frames")[0].at("sha256"), result.err, 0.0,
                stats.at("peak_memory_bytes").get<double>() / 1048576.0};
        const std::string about = " splats, about ";
        const std::size_t at = result.err.find(about);
        EXPECT_NE(at, std::string::npos) << result.err;
        std::istringstream rest(result.err.substr(at + about.size()));
        std::string unit;
        rest >> run.estimated_mib >> unit;
        if (unit == "GiB") run.estimated_mib *= 1024.0;
        return run;
    }

    /// The estimate is never less than what was taken, and at most a fifth more.
    static void expect_enough(const Run& run) {
        EXPECT_GE(run.estimated_mib, run.taken_mib) << run.err;
        EXPECT_LE(run.estimated_mib, 1.2 * run.taken_mib) << run.err;
    }
};

TEST_F(Memory, AFileLargerThanTheMemoryGivesTheSamePixels) {
    make_ball(1000000, "[64, 48]", "[layer.render]\nblend = \"hybrid\"\n[layer.look]\ndensity = 0.9\n");
    const Run whole = rendered({});
    EXPECT_EQ(whole.err.find("block by block"), std::string::npos) << whole.err;
    for (const auto& [threads, gib] : {std::pair("1", "0.1"), std::pair("2", "0.106")}) {
        const Run streamed = rendered({"--memory", gib, "-t", threads});
        EXPECT_HAS(streamed.err, "block by block, as there is not memory for all: ball");
        EXPECT_EQ(streamed.hash, whole.hash);
        EXPECT_LE(streamed.taken_mib, std::stod(gib) * 1024.0);
    }
    EXPECT_EQ(rendered({"--memory", "0.3"}).hash, whole.hash);
}

TEST_F(Memory, WhatWillNotFitIsSaidBeforeAnythingIsDone) {
    expect_one_line(batch({"--memory", "0.05"}), 2, "--memory: expected at least 0.");
    EXPECT_EQ(names_in("frames"), std::set<std::string>{});
}

TEST_F(Memory, ARunTakesWhatItAnnounces) {
    make_ball(2500000, "[640, 360]");
    const Run whole = rendered({});
    expect_enough(whole);
    const Run large = rendered({"--resolution", "3840x2160"});
    expect_enough(large);
    EXPECT_GT(large.taken_mib, whole.taken_mib + 100.0);
    // Away from the ball; then reading its file takes the most.
    expect_enough(rendered({"--set", "camera.target=[6.0, 12.0, 26.0]"}));
}

// Planes of every layer, two renderings of a blurred frame, a projection onto the sphere, and splats split in
// front of the camera; each of two layers in memory, then of one on disk where there is not room for both.
TEST_F(Memory, EveryKindOfFrameIsCounted) {
    make_ball(1000000, "[1280, 720]",
              "[[layer]]\nname = \"second\"\n[layer.source]\nkind = \"splats\"\nfile = \"ball.splats\"\n");
    const std::string aovs = "output.aovs=[\"depth\", \"coverage\", \"count\", \"layers\"]";
    const std::vector<Words> kinds = {
        {aovs},
        {"camera.shutter=180", "output.samples=4", aovs},
        {"camera.projection=equirectangular", "camera.position=[0.2, 0.1, 0.3]"},
        {"camera.position=[0.6, 0.4, 1.3]", "layer.ball.render.lod.max_px=8"},
        {"layer.ball.render.isolate=true", "layer.ball.render.blend=screen"}};
    for (const Words& kind : kinds) {
        Words words;
        for (const std::string& assignment : kind) words.insert(words.end(), {"--set", assignment});
        expect_enough(rendered(words));
    }
    const Run streamed = rendered({"--memory", "0.23", "--set", aovs});
    EXPECT_HAS(streamed.err, "block by block");
    expect_enough(streamed);
    // From within the ball few are drawn, and reading the second layer takes the most.
    expect_enough(rendered({"--set", "camera.position=[0.2, 0.1, 0.3]"}));
}

// More than what a small frame takes.
TEST_F(Memory, LibrariesThatReadPicturesAreCounted) {
    make_ball_to_generate(1000, "[3.0, 6.0, 13.0]");
    const Run run = rendered({});
    EXPECT_GT(run.estimated_mib, 100.0);
    expect_enough(run);
}

TEST_F(Memory, EveryFormatOfFramesIsCounted) {
    make_ball(1000, "[640, 360]");
    for (const char* ending : {"exr", "png", "tif"})
        for (const char* size : {"640x360", "1920x1080"}) {
            expect_enough(rendered(
                {"--set", fmt::format("output.path=frames/shot.####.{}", ending), "--resolution", size}));
        }
}

// Linux hands the size of a process on to the program that it starts.
TEST_F(Memory, TheProgramThatStartsThisOneIsNotCounted) {
    make_ball(1000, "[64, 36]");
    const std::vector<char> much(400'000'000, 'x');
    EXPECT_LT(rendered({}).taken_mib, 300.0) << much[much.size() / 2];
}

// Where its splats lie, and that none is split, only a small set made before tells.
TEST_F(Memory, ASetThatIsNotThereIsMadeSmallToBeSure) {
    make_ball_to_generate(2500000, "[3.0, 6.0, 13.0]", "[layer.render.lod]\nmax_px = 200.0\n");
    expect_enough(rendered({}));
}

TEST_F(Memory, GeneratingTakesWhatIsAnnounced) {
    make_ball_to_generate(2500000, "[3.0, 6.0, 13.0]");
    expect_enough(rendered({}));
}

// Splats close by, which are split, wide and out of the frame; their set is in the cache.
TEST_F(Memory, WhatAPassCloseByTakesIsEstimatedFromASample) {
    make_ball_to_generate(
        300000, "[0.6, 0.4, 1.3]",
        "[layer.render]\nlod = { max_px = 8 }\n[layer.look]\nradius = { min = 0.05, max = 0.05 }\n");
    expect_success(batch({"--sets-only", "-q"}));
    expect_enough(rendered({}, true));
}

// The same where the set is still to be made.
TEST_F(Memory, IntoHowManySplatsAreSplitIsNotGuessed) {
    make_ball_to_generate(
        300000, "[0.6, 0.4, 1.3]",
        "[layer.render]\nlod = { max_px = 8 }\n[layer.look]\nradius = { min = 0.05, max = 0.05 }\n");
    expect_enough(rendered({}));
}

// Sets of Gaussians stay whole alongside what the look makes of them, as their shapes do.
TEST_F(Memory, CapturesAreCountedWithTheirShapesAndHarmonics) {
    make_scene_of("capture.ply", "[640, 360]", "[0.0, 0.0, 14.0]");
    for (const int degree : {0, 3}) {
        write_text(folder / "capture.ply", ply_of(capture(300000, degree, 0.05), degree));
        expect_enough(rendered({}));
    }
}

// Away from them, so that making them takes the most: what is told is enough, of clouds and disks, and each
// texel of a cloud adds no more than what 8192x8192 px leave it of 6 GiB.
TEST_F(Memory, BodiesOfLargePicturesTakeFewBytesATexel) {
    struct Size {
        int width, height;
        double texels() const { return double(width) * height; }
    };
    constexpr Size small{1700, 1133}, large{2400, 1600};
    constexpr double most_a_texel = 6.0 * 1024.0 * 1048576.0 / (8192.0 * 8192.0);  // bytes
    std::vector<double> cloud_mib;
    for (const auto& [width, height] : {small, large}) {
        std::uint32_t state = 7;
        write_text(
            folder / "large.ppm", pixmap(width, height, [&](int x, int y, int k) {
                if (k == 0) state = state * 1664525u + 1013904223u;
                const double r = std::hypot(x - 0.5 * width, y - 0.5 * height) / height;
                return std::lround((1.0 - 0.2 * k) * std::max(0.0, 1.0 - r) * (150.0 + double(state >> 28)));
            }));
        for (const std::string_view kind : {"disk", "walls"}) {
            write_text(folder / "scene.toml", fmt::format(R"(astrosplat = 1
[output]
resolution = [64, 36]
frames = "1"
path = "frames/shot.####.exr"
[camera]
position = [0, 0, 40]
target = [0, 0, 80]
[[layer]]
name = "gas"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "large.ppm" }} ]
structure = {{ kind = "{}", margin = 0.0 }}
)",
                                                          kind));
            const Run run = rendered({});
            expect_enough(run);
            if (kind == "walls") cloud_mib.push_back(run.taken_mib);
        }
    }
    EXPECT_LT((cloud_mib[1] - cloud_mib[0]) * 1048576.0 / (large.texels() - small.texels()), most_a_texel);
}

TEST_F(Memory, ColumnsThatMemoryDoesNotHoldAreWrittenInParts) {
    make_ball(1'500'000, "[64, 36]");
    const RunResult parts = expect_success(run({"generate", "mesh.toml", "--layer", "ball", "-o",
                                                "parts.splats", "--memory", "0.2", "--no-cache", "-t", "1"}));
    EXPECT_HAS(parts.err, "it is written in parts");
    EXPECT_TRUE(text_of(folder / "parts.splats") == text_of(folder / "ball.splats"));
    // Other formats have no parts.
    expect_one_line(run({"generate", "mesh.toml", "--layer", "ball", "-o", "x.ply", "--memory", "0.2",
                         "--no-cache", "-q"}),
                    2, "which generate writes in parts");
}

// Also of one that is not seen, as it is read.
TEST_F(Memory, TheSkyIsCounted) {
    std::string sky = "P6\n3000 1500\n255\n";
    sky.append(3000 * 1500 * 3, '\x30');
    write_text(folder / "sky.ppm", sky);
    make_ball(1000, "[64, 36]", "[environment]\nimage = \"sky.ppm\"\n");
    for (const char* visible : {"true", "false"}) {
        expect_enough(rendered({"--set", fmt::format("environment.visible={}", visible)}));
    }
}

// Estimates before a run: of bodies from their pictures as they will be, of columns with the
// positions that are dropped at the end.

// A round cloud of 400x250 px that is speckled and fades to black: `reach` px from the middle
// there is nothing.
std::string cloud_picture(double reach) {
    constexpr int width = 400, height = 250;
    std::uint32_t state = 7;
    return pixmap(width, height, [&](int x, int y, int k) {
        if (k == 0) state = state * 1664525u + 1013904223u;
        const double r = std::hypot(x - 0.5 * width, y - 0.5 * height) / reach;
        const double light = std::max(0.0, 1.0 - r) * (150.0 + double(state >> 26));
        return std::lround((1.0 - 0.2 * k) * light);
    });
}

class Estimate : public SceneTest {
  protected:
    void write_source(const std::string& keys, double reach = 300.0) {
        write_text(folder / "cloud.ppm", cloud_picture(reach));
        write_text(folder / "scene.toml", R"(astrosplat = 1
[output]
resolution = [32, 20]
frames = "1"
path = "frames/shot.####.exr"
[[layer]]
name = "cloud"
[layer.source]
meshes = [ { mesh = "plane", texture = "cloud.ppm" } ]
)" + keys);
    }

    // Figures of a dry run: splats, and MiB.
    struct DryRun {
        double splats, mib;
    };
    DryRun dry_run(Words more = {}) const {
        more.insert(more.begin(), {"--dry-run", "-q"});
        const RunResult result = expect_success(batch(more));
        return {number_after(result.out, "about ", {{'k', 1e3}, {'M', 1e6}}),
                number_after(result.out, "memory about ", {{'M', 1.0}, {'G', 1024.0}})};
    }

    static double number_after(const std::string& text, const std::string& before,
                               const std::map<char, double>& units) {
        std::istringstream rest(text.substr(std::min(text.size(), text.find(before) + before.size())));
        double number = 0.0;
        char unit = 0;
        rest >> number >> unit;
        EXPECT_GT(number, 0.0) << text;
        return units.contains(unit) ? units.at(unit) * number : number;
    }

    std::int64_t made(Words more = {}) const {
        more.insert(more.begin(),
                    {"generate", "scene.toml", "--layer", "cloud", "-o", "set.splats", "--overwrite", "-q"});
        expect_success(run(more));
        return nlohmann::json::parse(run({"info", "set.splats", "--json"}).out).at("splats");
    }
};

const std::string bodies = "structure = { kind = \"sheet\" }\n";

TEST_F(Estimate, BodiesOfAReducedPictureAreThoseThatWillBeMade) {
    write_source(bodies);
    const Words little = {"--memory", "0.19"};
    const double whole = dry_run().splats, reduced = dry_run(little).splats;
    EXPECT_LT(reduced, 0.6 * whole);
    EXPECT_NEAR(reduced, double(made(little)), 0.1 * reduced);
    EXPECT_NEAR(whole, double(made()), 0.1 * whole);
}

TEST_F(Estimate, TheMemoryOfBodiesIsThatOfMakingThem) {
    write_source(bodies);
    const DryRun whole = dry_run();
    EXPECT_GT(whole.mib, 140.0 + 400.0 * 250.0 * 120.0 / 1048576.0);
    write_source(bodies + "splats = 20000\n");
    const DryRun few = dry_run();
    EXPECT_LE(few.splats, 20000.0);
    EXPECT_LT(few.mib, whole.mib - 10.0);
}

TEST_F(Estimate, ColumnsAskedForBySplatsHoldTransparentOnesWhileTheyAreMade) {
    const std::string keys = "splats = 1000000\n";
    write_source(keys);
    const DryRun lit = dry_run();
    write_source(keys, 60.0);  // an eighth of the picture
    const DryRun dark = dry_run();
    EXPECT_NEAR(dark.splats, lit.splats, 0.02 * lit.splats);
    EXPECT_GT(dark.mib, 2.0 * lit.mib);
}

TEST_F(Estimate, ARunWithLittleMemoryReducesThePictureOfBodiesAndSaysSoOnce) {
    write_source(bodies);
    const RunResult result = batch({"--memory", "0.19", "-q"});
    expect_one_line(result, 0, "a picture of 400x250 px is reduced to");
    EXPECT_EQ(names_in("frames"), std::set<std::string>{"shot.0001.exr"});
    EXPECT_LT(made({"--memory", "0.19"}), made() / 2);
}

// Of so few splats the sample is all: its frames are those that will be written.
TEST_F(Estimate, ADryRunTellsTimeAndTheSizeOfFiles) {
    write_scene();
    const RunResult result =
        expect_success(batch({"--dry-run", "-q", "-f", "1-3", "--resolution", "320x240"}));
    EXPECT_EQ(result.out.find("sets are made"), std::string::npos) << result.out;
    EXPECT_HAS(result.out, "\ntime about ");
    EXPECT_HAS(result.out, " s a frame, ");
    EXPECT_EQ(names_in("frames"), std::set<std::string>{});
    const double estimated =
        number_after(result.out, "files about ", {{'K', 1024.0}, {'k', 1024.0}, {'M', 1048576.0}});
    expect_success(batch({"-q", "-f", "1-3", "--resolution", "320x240"}));
    double taken = 0.0;
    for (const std::string& name : names_in("frames"))
        taken += double(fs::file_size(folder / "frames" / name)) / 3.0;
    EXPECT_NEAR(estimated, taken, 0.1 * taken);
}

TEST_F(Estimate, SetsThatAreMissingAreMadeSmall) {
    write_source(bodies);
    const RunResult before = batch({"--dry-run", "-q"});
    EXPECT_HAS(before.out, "sets are made in about ");
    EXPECT_EQ(names_in("sets"), std::set<std::string>{});
    expect_success(batch({"--sets-only", "-q"}));
    const RunResult after = batch({"--dry-run", "-q"});
    EXPECT_EQ(after.out.find("sets are made"), std::string::npos) << after.out;
    EXPECT_HAS(after.out, "time about ");
}

TEST_F(Estimate, WithNothingToRenderThereIsNothingToTell) {
    write_scene();
    expect_success(batch({"-q", "-f", "1"}));
    const RunResult result = batch({"--dry-run", "-q", "-f", "1", "--resume"});
    EXPECT_HAS(result.out, "0 to render");
    EXPECT_EQ(result.out.find("time about"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace astrosplat::test
