// --batch: which files appear, what is said where, and what they hold.
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <regex>
#include <thread>

#include "cli/scene_fixture.h"
#include "source/texture.h"
#include "support/color_config.h"
#include "support/process_state.h"

namespace astrosplat::test {
namespace {

class Batch : public SceneTest {
  protected:
    RunningProgram job(const Words& more) const {
        return started(joined({"--batch", "scene.toml", "--no-cache"}, more));
    }
};

int count_of(const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
    return count;
}

const std::set<std::string> three_frames = {"shot.0001.exr", "shot.0002.exr", "shot.0003.exr"};

TEST_F(Batch, RendersEveryFrameAndSaysSo) {
    const RunResult result = expect_success(batch());
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(names_in("frames"), three_frames);
    EXPECT_TRUE(std::regex_search(
        result.err,
        std::regex(
            "astrosplat: frame 2 \\(2/3\\) [0-9]+% eta (([0-9]{2}|--):?){3}, all (3[3-9]|[456][0-9])% eta "
            "(([0-9]{2}|--):?){3}\n")))
        << result.err;
    EXPECT_TRUE(std::regex_search(result.err, std::regex("saved .*shot\\.0003\\.exr [0-9]+\\.[0-9]{2}s\n")))
        << result.err;
}

TEST_F(Batch, PairsAreWrittenWhereTheNameHasAPlaceForTheEye) {
    const Words one = {"-q", "--frames", "1", "--set", "camera.eye_separation=0.5"};
    const auto run = [&](const Words& more) { expect_success(batch(joined(one, more))); };
    run({"-o", "frames/%V.###.exr"});
    EXPECT_EQ(names_in("frames"), (std::set<std::string>{"left.001.exr", "right.001.exr"}));
    run({"-o", "frames/middle.exr"});
    const auto bytes = [&](const std::string& name) { return text_of(folder / "frames" / name); };
    EXPECT_TRUE(bytes("left.001.exr") != bytes("right.001.exr"));
    EXPECT_TRUE(bytes("left.001.exr") != bytes("middle.exr"));
    for (const char* eye : {"left", "right"}) {
        run({"-o", "frames/one.exr", "--overwrite", "--set", fmt::format("camera.eye={}", eye)});
        EXPECT_TRUE(bytes("one.exr") == bytes(fmt::format("{}.001.exr", eye))) << eye;
    }
    // One of them is missing; the other one is kept.
    fs::remove(folder / "frames/right.001.exr");
    EXPECT_EQ(count_of(batch({"--frames", "1", "--set", "camera.eye_separation=0.5", "-o",
                              "frames/%V.###.exr", "--resume"})
                           .err,
                       "saved "),
              1);
    const RunResult round = batch({"-o", "%V.exr", "--frames", "1", "--set", "camera.projection=fisheye"});
    EXPECT_EQ(round.code, 2);
    EXPECT_HAS(round.err, "found fisheye");
}

TEST_F(Batch, QuietSaysNothing) {
    EXPECT_EQ(batch({"-q"}).err, "");
    const RunResult plain = batch({"-q", "--progress", "plain", "--overwrite"});
    EXPECT_HAS(plain.err, "saved ");
}

TEST_F(Batch, OptionsComeInAnyOrder) {
    expect_success(run({"-f", "2", "scene.toml", "-t", "1", "--batch", "-q"}));
    EXPECT_EQ(names_in("frames"), std::set<std::string>{"shot.0002.exr"});
    expect_success(run({"--batch", "--set", "output.fps=30", "--set", "output.frames=3", "scene.toml"}));
    EXPECT_EQ(names_in("frames"), (std::set<std::string>{"shot.0002.exr", "shot.0003.exr"}));
}

TEST_F(Batch, FramesAreThoseAskedFor) {
    expect_success(batch({"--frames", "-2-0,5-9x2", "-o", "a/f%02d.png"}));
    EXPECT_EQ(names_in("a"),
              (std::set<std::string>{"f-02.png", "f-01.png", "f00.png", "f05.png", "f07.png", "f09.png"}));
    expect_success(batch({"-f", "12", "-o", "b/{frame:03}.tif"}));
    EXPECT_EQ(names_in("b"), std::set<std::string>{"012.tif"});
}

TEST_F(Batch, PathsOfTheSceneStartAtItsFolderThoseOfTheCommandLineHere) {
    fs::create_directories(folder / "elsewhere");
    const RunOptions elsewhere{.folder = folder / "elsewhere"};
    expect_success(run({"--batch", "../scene.toml", "-f", "1"}, elsewhere));
    EXPECT_TRUE(fs::exists(folder / "frames/shot.0001.exr"));
    expect_success(run({"--batch", "../scene.toml", "-f", "1", "-o", "here.exr"}, elsewhere));
    EXPECT_TRUE(fs::exists(folder / "elsewhere/here.exr"));
    expect_success(run({"--batch", "../scene.toml", "-f", "1", "--set", "output.path=set.exr"}, elsewhere));
    EXPECT_TRUE(fs::exists(folder / "elsewhere/set.exr"));
}

TEST_F(Batch, PathsMayHoldSpacesAndUmlauts) {
    const fs::path odd = folder / "Große Nebel ☆";
    fs::create_directories(odd);
    for (const char* name : {"scene.toml", "stars.pda", "dust.pda"}) fs::copy(folder / name, odd / name);
    expect_success(run({"--batch", (odd / "scene.toml").string(), "-f", "1", "-o", "Bilder/ä ö.####.exr"},
                       {.folder = odd}));
    EXPECT_TRUE(fs::exists(odd / "Bilder/ä ö.0001.exr"));
}

// Folders that a scene lies in, or that a name goes to, need no frame numbers or eyes.
TEST_F(Batch, FoldersMayBeNamedLikePatterns) {
    const fs::path odd = folder / "C#1 100%v {frame}";
    fs::create_directories(odd);
    for (const char* name : {"scene.toml", "stars.pda", "dust.pda"}) fs::copy(folder / name, odd / name);
    const auto expect_file = [&](Words words, const fs::path& file) {
        words.insert(words.begin(), {"--batch", (odd / "scene.toml").string(), "-q", "-f", "5"});
        expect_success(run(words, {.folder = odd}));
        EXPECT_TRUE(fs::exists(file)) << file;
    };
    expect_file({}, odd / "frames/shot.0005.exr");
    expect_file({"-o", "out.png"}, odd / "out.png");
    expect_file({"-o", "%V/a.##.png"}, odd / "right/a.05.png");
    expect_file({"-o", (odd / "b.##.png").string()}, odd / "b.05.png");
    expect_file({"--set", "output.path=set.exr"}, odd / "set.exr");
    EXPECT_EQ(names_in("."),
              (std::set<std::string>{odd.filename().string(), "dust.pda", "scene.toml", "stars.pda"}));
}

TEST_F(Batch, NeedsNoDisplay) {
    expect_success(
        batch({"-f", "1"}, {.without = {"DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR", "HOME", "LANG"}}));
}

TEST_F(Batch, DryRunTellsAndWritesNothing) {
    const RunResult result = expect_success(batch({"--dry-run", "--stats", "stats.json"}));
    EXPECT_HAS(result.out, "3 to render");
    EXPECT_HAS(result.out, "shot.0003.exr");
    EXPECT_HAS(result.out, "memory about");
    EXPECT_EQ(names_in("."), (std::set<std::string>{"scene.toml", "stars.pda", "dust.pda"}));
}

/// Four floats a pixel, and four more as it is written, with 256 rows as they are stored, in half; extra
/// outputs theirs. The estimate is a tenth more than that.
TEST_F(Batch, DryRunEstimatesThePicturesThatAreKept) {
    const auto mib = [&](const Words& more) {
        const RunResult result = batch(joined({"--dry-run", "-f", "1"}, more));
        const std::string before = "memory about ";
        EXPECT_HAS(result.out, " MiB, threads");
        return std::stod(result.out.substr(result.out.find(before) + before.size()));
    };
    const auto estimated = [](double rows, double bytes, double stored_bytes) {
        return 1.1 * 2000.0 * (rows * bytes + 256.0 * stored_bytes) / 1048576.0;
    };
    const double small = mib({});
    EXPECT_NEAR(mib({"--resolution", "2000x1500"}) - small, estimated(1500.0, 32.0, 8.0), 2.0);
    EXPECT_NEAR(mib({"--resolution", "2000x1500", "--set", "output.aovs=[\"depth\"]"}) - small,
                estimated(1500.0, 32.0 + 4.0, 8.0 + 4.0), 2.0);
    EXPECT_NEAR(mib({"--resolution", "2000x1500", "--region", "0,0,2000,500"}) - small,
                estimated(500.0, 32.0, 8.0), 2.0);
}

TEST_F(Batch, StatsHoldTheKeysOfTheContract) {
    expect_success(batch({"--stats", "figures/stats.json", "-t", "2"}));
    const nlohmann::json stats = json("figures/stats.json");
    ASSERT_EQ(stats.at("frames").size(), 3u);
    for (const char* key :
         {"frame", "file", "seconds", "render_seconds", "splats_in", "splats_drawn", "sha256"})
        EXPECT_TRUE(stats.at("frames")[0].contains(key)) << key;
    ASSERT_EQ(stats.at("layers").size(), 2u);
    for (const char* key : {"name", "test_positions", "kept", "zero_alpha", "drawn", "generate_seconds",
                            "look_seconds", "cached", "geometry_cached"})
        EXPECT_TRUE(stats.at("layers")[0].contains(key)) << key;
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
    expect_success(batch({"-f", "1", "--layers", "dust", "--stats", "stats.json"}));
    EXPECT_EQ(json("stats.json").at("frames")[0].at("splats_in"), 100);
    EXPECT_EQ(json("stats.json").at("layers")[0].at("kept"), 0) << "a layer that is not drawn is not loaded";
}

TEST_F(Batch, LayersHideWhatATrackShows) {
    write_scene("\"layer.stars.visible\" = { keys = [[1, true], [2, false]] }\n");
    expect_success(batch({"-f", "1", "--layers", "dust", "--stats", "stats.json"}));
    EXPECT_EQ(json("stats.json").at("frames")[0].at("splats_in"), 100);
    expect_success(batch({"-f", "1-2", "--layers", "dust,stars", "--overwrite", "--stats", "stats.json"}));
    EXPECT_EQ(json("stats.json").at("frames")[0].at("splats_in"), 400);
    EXPECT_EQ(json("stats.json").at("frames")[1].at("splats_in"), 100) << "what is asked for keeps its track";
}

TEST_F(Batch, ResolutionIsASizeOrAShare) {
    for (const auto& [text, size] : {std::pair{"50%", "32"}, std::pair{"40x30", "40"}}) {
        expect_success(batch({"-f", "1", "--resolution", text, "-o", "p.png", "--overwrite"}));
        const nlohmann::json info = nlohmann::json::parse(run({"info", "p.png", "--json"}).out);
        EXPECT_EQ(info.at("width").dump(), size);
    }
}

TEST_F(Batch, RefusesToOverwrite) {
    expect_success(batch({"-f", "2"}));
    const std::string before = text_of(folder / "frames/shot.0002.exr");
    const RunResult result = batch({"--set", "output.exposure=1"});
    expect_one_line(result, 2, "shot.0002.exr");
    EXPECT_EQ(names_in("frames").size(), 1u);
    EXPECT_EQ(text_of(folder / "frames/shot.0002.exr"), before);
    expect_success(batch({"--overwrite"}));
    EXPECT_EQ(names_in("frames"), three_frames);
}

TEST_F(Batch, AFrameThatFailsSparesTheOthers) {
    // Only the second frame shows anything, and takes more than the disk has left.
    write_scene(
        "\"layer.stars.visible\" = { keys = [[1, false], [2, true], [3, false]] }\n"
        "\"layer.dust.visible\" = { keys = [[1, false]] }\n");
    const RunResult result = [&] {
        const FileLimit full(4000);
        return batch();
    }();
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_HAS(result.err, "shot.0002.exr: cannot be written: File too large");
    EXPECT_TRUE(std::regex_search(last_line(result.err), std::regex("1 frame failed: 2$"))) << result.err;
    EXPECT_EQ(names_in("frames"), (std::set<std::string>{"shot.0001.exr", "shot.0003.exr"}));
    expect_success(batch({"--resume", "--stats", "stats.json"}));
    EXPECT_EQ(json("stats.json").at("frames").size(), 1u) << "the others are whole";
}

TEST_F(Batch, AFullDiskKeepsTheOldFrames) {
    for (const char* output : {"f.####.png", "f.####.tif", "f.####.exr"}) {
        expect_success(batch({"-f", "1", "-o", output}));
        const std::string name = std::string("f.0001") + fs::path(output).extension().string();
        const std::string before = text_of(folder / name);
        const RunResult result = [&] {
            const FileLimit full(before.size() / 2);
            return batch({"-f", "1", "-o", output, "--overwrite"});
        }();
        EXPECT_EQ(result.code, 3) << output << result.err;
        EXPECT_EQ(result.err.find("saved"), std::string::npos) << result.err;
        EXPECT_TRUE(text_of(folder / name) == before) << output;
    }
}

TEST_F(Batch, FailuresAreInTheFigures) {
    write_text(folder / "frames/keep", "");
    fs::create_symlink("nowhere/shot.exr", folder / "frames/shot.0002.exr");
    const RunResult result = batch({"--overwrite", "--stats", "stats.json"});
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_EQ(json("stats.json").at("frames").size(), 2u);
    EXPECT_EQ(json("stats.json").at("failed")[0].at("frame"), 2);
    EXPECT_TRUE(std::regex_search(last_line(result.err), std::regex("1 frame failed: 2$"))) << result.err;
}

TEST_F(Batch, BadInputThatShowsInTheFirstFrameEndsTheRun) {
    // At frame 1 the camera looks at where it is.
    const RunResult first = batch({"--set", "camera.target=[0, 0, 9]"});
    EXPECT_EQ(first.code, 2) << first.err;
    EXPECT_HAS(last_line(first.err), "camera.target: expected");
    EXPECT_EQ(names_in("frames").size(), 0u);
    const RunResult last = batch({"--set", "camera.target=[2, 1, 8]"});
    EXPECT_EQ(last.code, 3) << last.err;
    EXPECT_TRUE(std::regex_search(last_line(last.err), std::regex("1 frame failed: 3$"))) << last.err;
    EXPECT_EQ(names_in("frames").size(), 2u);
}

TEST_F(Batch, MapsAreReadBeforeTheFirstFrame) {
    write_text(folder / "map.png", "no picture");
    write_text(folder / "picture.ppm", small_picture());
    write_scene(
        "[[layer]]\nname = \"gas\"\n[layer.source]\nmeshes = [ { mesh = \"plane\", texture = "
        "\"picture.ppm\" } ]\ncount = 1000\n"
        "[layer.look]\nthickness = { map = \"map.png\", keys = [{ color = [1.0, 1.0, 1.0], scale = "
        "1.0 }] }\n");
    const RunResult result = batch();
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_HAS(last_line(result.err), "map.png");
    EXPECT_EQ(result.err.find("frame 1 (1/3)"), std::string::npos) << result.err;
}

TEST_F(Batch, WhatCannotBeRenderedIsSaidWithItsLine) {
    const auto expect_refused = [&](const std::string& place, const std::string& part) {
        for (const Words& words : {Words{"--batch", "scene.toml"},
                                   {"--batch", "scene.toml", "--dry-run"},
                                   {"info", "scene.toml"}}) {
            const RunResult result = run(words);
            expect_one_line(result, 2, place);
            EXPECT_HAS(result.err, part);
        }
        EXPECT_FALSE(fs::exists(folder / "frames"));
    };
    const std::string plain = text_of(folder / "scene.toml");
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = plain;
        text.replace(text.find(from), from.size(), to);
        write_text(folder / "scene.toml", text);
    };
    with("[camera]\n", "[camera]\nprojection = \"fisheye\"\nfisheye_fov = 361\n");
    expect_refused("scene.toml:8: camera.fisheye_fov: ", "found 361");
    with("[camera]\n", "[camera]\nprojection = \"pinhole\"\n");
    expect_refused("scene.toml:7: camera.projection: ", "found 'pinhole'");
    with("[camera]\n", "[camera]\nfile = \"path.txt\"\n");
    expect_refused("scene.toml:7: camera.file: expected a name ending in .chan", "path.txt'");
    with("[camera]\n", "[camera]\nfile = \"path.chan\"\n");
    expect_refused("scene.toml:7: camera.file: ", "path.chan: cannot be read: No such file or directory");
    with("file = \"stars.pda\"", "file = \"stars.bgeo\"");
    expect_refused("scene.toml:12: layer.stars.source.file: ", "stars.bgeo");
    EXPECT_EQ(batch({"-f", "1", "--layers", "dust"}).code, 0) << "a layer that is not asked for does no harm";
}

TEST_F(Batch, InputsThatChangeBeforeTheyAreLoadedAreRefused) {
    write_text(folder / "frames/shot.0001.exr", "damaged");
    ASSERT_EQ(mkfifo((folder / "err").c_str(), 0600), 0);
    const int pipe = open((folder / "err").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(fcntl(pipe, F_SETPIPE_SZ, 4096), 4096);
    // Room for the message that the plan ends with, not for the next one, at which the program then waits.
    const std::string planned =
        "astrosplat: " + (folder / "frames/shot.0001.exr").string() + ": damaged, is rendered again\n";
    const std::string filling(4096 - planned.size() - 20, '.');
    ASSERT_EQ(write(pipe, filling.data(), filling.size()), static_cast<ssize_t>(filling.size()));
    const RunningProgram program({"/bin/sh", "-c", "exec \"$0\" \"$@\" 2>err", ASTROSPLAT_PROGRAM, "--batch",
                                  "scene.toml", "-f", "1", "--resume", "--no-cache"},
                                 {.folder = folder});
    const auto waiting = [&] {
        int bytes = 0;
        return ioctl(pipe, FIONREAD, &bytes) == 0 && std::size_t(bytes) >= filling.size() + planned.size();
    };
    while (program.running() && !waiting()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    write_text(folder / "stars.pda", cube_of_splats(299));
    std::string said;
    char block[4096];
    for (bool running = true; running;) {
        running = program.running();
        for (ssize_t size = 0; (size = read(pipe, block, sizeof block)) > 0;)
            said.append(block, std::size_t(size));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    close(pipe);
    EXPECT_EQ(program.wait().code, 2) << said;
    EXPECT_HAS(last_line(said), "stars.pda: expected the file that the frames were planned with");
    EXPECT_EQ(text_of(folder / "frames/shot.0001.exr"), "damaged");
}

TEST_F(Batch, FoldersAndDevicesInAFramesPlaceAreSeenBeforeAnyWork) {
    fs::create_directories(folder / "frames/shot.0003.exr");
    ASSERT_EQ(mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
    for (const Words& options : {Words{}, {"--overwrite"}, {"--resume"}, {"--dry-run", "--overwrite"}}) {
        expect_one_line(batch(options), 4, "shot.0003.exr: cannot be written: it is a folder");
        const Words pipe = joined(options, {"-f", "1", "-o", "pipe.exr"});
        expect_one_line(batch(pipe), 4, "pipe.exr: cannot be written: it is no regular file");
    }
    EXPECT_EQ(names_in("frames"), std::set<std::string>{"shot.0003.exr"});
}

TEST_F(Batch, FramesRemovedDuringTheRunAreMissed) {
    const RunningProgram job = this->job({"-f", "1-40", "--resolution", "400x300"});
    job.wait_until_said("saved ");
    std::error_code busy;
    do fs::remove_all(folder / "frames", busy);
    while (busy);  // the next frame came into the folder as it was emptied
    const RunResult result = job.wait();
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_HAS(result.err, "shot.0001.exr: removed during the run");
    EXPECT_TRUE(std::regex_search(last_line(result.err), std::regex("failed: 1[,\n]?"))) << result.err;
}

TEST_F(Batch, OfTwoRunsOnOnePatternTheSecondLoses) {
    const RunningProgram first = job({"-f", "1-3"}), second = job({"-f", "1-3"});
    const RunResult a = first.wait(), b = second.wait();
    EXPECT_EQ(names_in("frames"), three_frames);
    const auto saved = [](const RunResult& run) { return count_of(run.err, "saved "); };
    EXPECT_EQ(saved(a) + saved(b), 3) << "each frame is written once:\n" << a.err << b.err;
    EXPECT_NE(a.code == 0 && b.code == 0, true) << a.err << b.err;
}

TEST_F(Batch, FramesThatAppearDuringTheRunAreKept) {
    const auto run_into = [&](const Words& options) {
        const RunningProgram job = this->job(joined({"-f", "1-12", "--resolution", "400x300"}, options));
        job.wait_until_said("saved ");
        fs::copy(folder / "other.exr", folder / "frames/shot.0012.exr", fs::copy_options::skip_existing);
        return job.wait();
    };
    expect_success(batch({"-f", "12", "--resolution", "400x300", "-o", "other.exr"}));
    const std::string other = text_of(folder / "other.exr");
    const RunResult result = run_into({});
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_TRUE(std::regex_search(last_line(result.err), std::regex("1 frame failed: 12$"))) << result.err;
    EXPECT_TRUE(text_of(folder / "frames/shot.0012.exr") == other);
    fs::remove_all(folder / "frames");
    EXPECT_EQ(run_into({"--resume"}).code, 0) << "a frame of the right hash is as good as one's own";
}

TEST_F(Batch, LeftoversOfKilledRunsAreRemoved) {
    const RunningProgram job = this->job({"-f", "1-2000", "--resolution", "640x480"});
    job.wait_until_said("saved ");
    write_text(folder / "frames/.shot.0001.1-2-3.part.exr", "half");
    job.signal(SIGKILL);
    EXPECT_EQ(job.wait().code, -SIGKILL);
    expect_success(batch({"-f", "1", "--overwrite"}));
    for (const std::string& name : names_in("frames")) EXPECT_EQ(name.substr(0, 5), "shot.") << name;
}

TEST_F(Batch, NamesAreShownWithoutControlCharacters) {
    const std::string odd = "f\n\x1b[31m.####.png";
    const RunResult run = expect_success(batch({"-f", "1", "-o", odd}));
    EXPECT_TRUE(fs::exists(folder / "f\n\x1b[31m.0001.png"));
    EXPECT_HAS(run.err, "f\\n\\x1b[31m.0001.png");
    const RunResult again = batch({"-f", "1", "-o", odd}),
                    dry = batch({"--dry-run", "--overwrite", "-f", "1", "-o", odd});
    expect_one_line(again, 2, "f\\n\\x1b[31m.0001.png");
    for (const std::string& text : {run.err, again.err, dry.out})
        EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
    EXPECT_HAS(dry.out, "f\\n\\x1b[31m.0001.png\n");
}

TEST_F(Batch, OneIsSingular) {
    write_text(folder / "stars.pda", cube_of_splats(1));
    const RunResult run =
        batch({"-f", "1", "--layers", "stars", "-v", "--set", "layer.stars.source.kind=splats"});
    EXPECT_HAS(run.err, " 1 frame of 64x48 px, about ");
    EXPECT_HAS(run.err, "frame 1: 1 splat drawn");
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

// Frames that are written through a configuration of OpenColorIO: whose numbers, what their hash knows, and
// what is said where a name is wrong.

class ColorConfigBatch : public SceneTest {
  protected:
    ColorConfigBatch() { write_color_config(folder); }

    RunResult one(const std::string& file, Words more, const std::string& ocio = "") const {
        return batch(joined(more, {"-q", "--frames", "1", "-o", file}), {.environment = {"OCIO=" + ocio}});
    }
    static Words film() {
        return {"--set", "output.ocio.config=\"colors.ocio\"", "--set", "output.exposure=1"};
    }
};

TEST_F(ColorConfigBatch, PicturesHoldTheViewAndLightStaysLight) {
    for (const char* file : {"light.exr", "film.png"}) {
        Words more = film();
        if (std::string(file) == "film.png") more.insert(more.end(), {"--set", "output.depth=\"16\""});
        ASSERT_EQ(one(file, more).code, 0) << file;
    }
    expect_success(one("plain.exr", {"--set", "output.exposure=1"}));
    EXPECT_TRUE(text_of(folder / "light.exr") == text_of(folder / "plain.exr"))
        << "scene light knows no view, nor does its hash";
    const Image light = load_raw_image(folder / "light.exr"), shown = load_raw_image(folder / "film.png");
    int bright = 0;
    for (std::int64_t y = 0; y < light.height; ++y)
        for (std::int64_t x = 0; x < light.width; ++x) {
            const float* p = light.at(x, y);
            const auto expected = test::film(2.0 * p[0], 2.0 * p[1], 2.0 * p[2]);
            bright += p[0] > 0.05f;
            for (int c = 0; c < 3; ++c)  // light is stored in half floats
                ASSERT_NEAR(shown.at(x, y)[c], expected[std::size_t(c)], 2e-3) << x << " " << y;
        }
    EXPECT_GT(bright, 100);
}

TEST_F(ColorConfigBatch, TheSceneNamesItOrTheEnvironment) {
    write_scene("[output.ocio]\nconfig = \"colors.ocio\"\nview = \"Negative\"\n");
    expect_success(one("scene.png", {}));
    write_scene();
    expect_success(
        one("named.png", {"--set", "output.ocio.view=\"Negative\""}, (folder / "colors.ocio").string()));
    EXPECT_TRUE(text_of(folder / "scene.png") == text_of(folder / "named.png"));
    expect_success(one("own.png", {}));
    expect_success(one("unasked.png", {}, (folder / "colors.ocio").string()));
    EXPECT_TRUE(text_of(folder / "own.png") == text_of(folder / "unasked.png"))
        << "a scene that names nothing is the same everywhere";
    EXPECT_FALSE(text_of(folder / "own.png") == text_of(folder / "named.png"));
}

TEST_F(ColorConfigBatch, OtherBytesOfTheConfigurationOrItsTablesAreAnotherFrame) {
    const Words words{"--set", "output.ocio.config=\"colors.ocio\"", "--set", "output.ocio.view=\"Negative\"",
                      "--resume"};
    expect_success(one("a.png", words));
    expect_success(one("a.png", words));
    for (const char* name : {"negative.cube", "colors.ocio"}) {
        const std::string before = text_of(folder / name);
        write_text(folder / name, before + "# another byte\n");
        const RunResult other = one("a.png", words);
        EXPECT_EQ(other.code, 2) << name;
        EXPECT_HAS(other.err, "holds a frame of other settings");
        write_text(folder / name, before);
    }
    expect_success(one("a.png", words));
}

TEST_F(ColorConfigBatch, OneLineAndNothingIsStarted) {
    write_scene("[output.ocio]\nconfig = \"colors.ocio\"\ndisplay = \"Screan\"\n");
    const RunResult display = one("a.png", {});
    EXPECT_EQ(display.code, 2);
    const std::string line =
        "scene.toml:24: output.ocio.display: expected Screen or Projector of colors.ocio, found 'Screan'\n";
    EXPECT_HAS(display.err, line);
    EXPECT_EQ(one("a.exr", {}).code, 0) << "no view is written";
    write_scene();
    const RunResult missing = one("a.png", {"--set", "output.ocio.config=\"missing.ocio\""});
    EXPECT_EQ(missing.code, 2);
    EXPECT_HAS(missing.err, "missing.ocio: cannot be read: No such file");
    const RunResult none = one("a.png", {"--set", "output.ocio.view=\"Film\""});
    EXPECT_EQ(none.code, 2);
    EXPECT_HAS(none.err, "output.ocio.config: expected a file");
    for (const RunResult& inside : {one("a.png", {"--set", "output.ocio.config=\"ocio://default\""}),
                                    one("a.png", {"--set", "output.ocio.view=\"x\""}, "ocio://default")})
        expect_one_line(inside, 2, "ocio://default: expected a configuration's file");
    EXPECT_FALSE(fs::exists(folder / "a.png"));
}

}  // namespace
}  // namespace astrosplat::test
