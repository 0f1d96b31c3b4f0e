// Frames that are there: verify, --resume and status.
#include <sys/stat.h>
#include <sys/xattr.h>

#include <cstring>
#include <sstream>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

// verify: each of its four verdicts, for every format, pairs, parts of frames, and frames of older versions.

class Verify : public SceneTest {
  protected:
    void render(Words more) const {
        more.emplace_back("-q");
        expect_success(batch(more));
    }
    RunResult verify(const Words& files, Words more = {}) const {
        more.insert(more.begin(), {"verify", "scene.toml"});
        more.insert(more.end(), files.begin(), files.end());
        return run(joined(more, {"-q"}));
    }
    void expect_equal(const Words& files, const Words& more = {}) const {
        const RunResult result = expect_success(verify(files, more));
        std::string expected;
        for (const std::string& file : files) expected += file + ": equal\n";
        EXPECT_EQ(result.out, expected);
        EXPECT_EQ(result.err, "");
    }
    nlohmann::json only_verdict(const std::string& file, Words more = {}) const {
        more.emplace_back("--json");
        const RunResult result = verify({file}, more);
        EXPECT_EQ(result.code, 3) << result.err;
        const nlohmann::json list = nlohmann::json::parse(result.out);
        EXPECT_EQ(list.size(), 1u);
        EXPECT_EQ(list.at(0).at("file"), file);
        return list.at(0);
    }
};

/// A PNG's chunks, signature apart: type and all bytes.
std::vector<std::pair<std::string, std::string>> chunks_of(const std::string& png) {
    std::vector<std::pair<std::string, std::string>> chunks;
    for (std::size_t at = 8; at + 12 <= png.size();) {
        std::size_t length = 0;
        for (int i = 0; i < 4; ++i) length = length * 256 + static_cast<unsigned char>(png[at + i]);
        chunks.emplace_back(png.substr(at + 4, 4), png.substr(at, length + 12));
        at += length + 12;
    }
    return chunks;
}

/// The first PNG with the pixels of the second.
std::string with_pixels_of(const std::string& first, const std::string& second) {
    std::string png = first.substr(0, 8), pixels;
    for (const auto& [type, bytes] : chunks_of(second))
        if (type == "IDAT") pixels += bytes;
    for (const auto& [type, bytes] : chunks_of(first)) {
        if (type == "IDAT")
            png += std::exchange(pixels, "");
        else
            png += bytes;
    }
    return png;
}

/// As a version wrote it that did not tell the keys.
std::string without_keys(const std::string& png) {
    std::string older = png.substr(0, 8);
    int left_out = 0;
    for (const auto& [type, bytes] : chunks_of(png)) {
        const bool keys = bytes.find("astrosplat/hashed") != bytes.npos;
        left_out += keys;
        if (!keys) older += bytes;
    }
    EXPECT_EQ(left_out, 1);
    return older;
}

const Words all_aovs = {"--set", "output.aovs=[\"depth\",\"coverage\",\"count\",\"layers\"]"};

TEST_F(Verify, FramesOfEveryFormatAreEqual) {
    render({});
    expect_equal({"frames/shot.0001.exr", "frames/shot.0002.exr", "frames/shot.0003.exr"});
    expect_equal({"frames/shot.0003.exr", "frames/shot.0001.exr"});
    for (const char* name : {"a.png", "a.tif"}) {
        render({"-f", "2", "-o", name});
        expect_equal({name});
    }
    for (const char* name : {"b.png", "b.tif"}) {
        render({"-f", "2", "-o", name, "--set", "output.depth=16"});
        expect_equal({name}, {"--set", "output.depth=16"});
    }
    Words more = {"-f", "1", "-o", "all.exr"};
    more.insert(more.end(), all_aovs.begin(), all_aovs.end());
    render(more);
    expect_equal({"all.exr"}, all_aovs);
    EXPECT_FALSE(fs::exists(folder / "frame.exr"));
}

TEST_F(Verify, OfItsOwnSizeRegionEyeAndLayers) {
    const Words pair = {"--set", "camera.eye_separation=0.5"};
    render({"-f", "1", "-o", "%V.exr", "--set", "camera.eye_separation=0.5"});
    render({"-f", "1", "-o", "%V.png", "--set", "camera.eye_separation=0.5"});
    expect_equal({"left.exr", "right.exr", "left.png", "right.png"}, pair);
    for (const char* name : {"part.exr", "part.png", "part.tif"}) {
        render({"-f", "2", "-o", name, "--region", "10,20,32,16"});
        expect_equal({name});
    }
    render({"-f", "2", "-o", "small.png", "--resolution", "50%"});
    expect_equal({"part.png", "small.png", "part.exr", "small.png"});
    render({"-f", "2", "-o", "dust.exr", "--layers", "dust"});
    expect_equal({"dust.exr"}, {"--layers", "dust"});
    EXPECT_EQ(only_verdict("dust.exr").at("verdict"), "made from another scene");
}

TEST_F(Verify, CompressionDoesNotCount) {
    const std::string lossy = "output.compression=dwaa";
    render({"-f", "1", "-o", "lossy.exr", "--set", lossy});
    render({"-f", "1", "-o", "exact.exr"});
    ASSERT_NE(verify({"lossy.exr"}).out, "");
    expect_equal({"lossy.exr", "exact.exr"});
    expect_equal({"lossy.exr", "exact.exr"}, {"--set", lossy});
}

TEST_F(Verify, OneValueThatIsOtherIsFoundAndMeasured) {
    const Words raw = {"--set", "output.depth=float", "--set", "output.compression=none"};
    Words more = {"-f", "1", "-o", "raw.exr"};
    more.insert(more.end(), raw.begin(), raw.end());
    render(more);
    expect_equal({"raw.exr"}, raw);
    std::string bytes = text_of(folder / "raw.exr");
    float value = 0.0f;  // R of the last pixel, as channels lie in the order of their names
    std::memcpy(&value, bytes.data() + bytes.size() - 4, 4);
    const double before = double(value);
    value = float(before + 2.5);
    std::memcpy(bytes.data() + bytes.size() - 4, &value, 4);
    write_text(folder / "raw.exr", bytes);
    const nlohmann::json verdict = only_verdict("raw.exr", raw);
    EXPECT_EQ(verdict.at("verdict"), "different");
    EXPECT_EQ(verdict.at("differing_pixels"), 1);
    EXPECT_EQ(verdict.at("pixels"), 64 * 48);
    EXPECT_NEAR(verdict.at("max_difference").get<double>(), 2.5, 1e-6);
    EXPECT_EQ(verdict.at("max_at"), (nlohmann::json{63, 47}));
    EXPECT_EQ(verdict.at("max_channel"), "R");
    EXPECT_NEAR(verdict.at("psnr_db").get<double>(), 10.0 * std::log10(64 * 48 * 4 / 6.25), 1e-3);
    const RunResult line = verify({"raw.exr"}, raw);
    EXPECT_EQ(line.code, 3);
    EXPECT_HAS(line.out, "raw.exr: different: 1 of 3072 pixels, by at most 2.5 in R at 63,47, PSNR 32.9 dB");
}

TEST_F(Verify, PixelsOfAnotherFrameInAPngAreFound) {
    for (const char* frame : {"1", "2"}) render({"-f", frame, "-o", std::string(frame) + ".png"});
    const std::string one = text_of(folder / "1.png"), two = text_of(folder / "2.png");
    write_text(folder / "mixed.png", with_pixels_of(one, two));
    ASSERT_NE(text_of(folder / "mixed.png"), one);
    const nlohmann::json verdict = only_verdict("mixed.png");
    EXPECT_EQ(verdict.at("verdict"), "different");
    EXPECT_GT(verdict.at("differing_pixels").get<int>(), 100);
    // Codes of 8 bits are compared, as the file holds them, not light.
    const double codes = verdict.at("max_difference").get<double>() * 255.0;
    EXPECT_NEAR(codes, std::round(codes), 1e-3);
}

TEST_F(Verify, AFrameOfAnotherPixelHashIsDifferentThoughItsFileRoundsToTheSame) {
    render({"-f", "1", "-o", "a.tif"});
    std::string bytes = text_of(folder / "a.tif");
    const std::size_t at = bytes.find("astrosplat/pixelHash=") + 21;
    bytes[at] = bytes[at] == '0' ? '1' : '0';
    write_text(folder / "a.tif", bytes);
    const nlohmann::json verdict = only_verdict("a.tif");
    EXPECT_EQ(verdict.at("verdict"), "different");
    EXPECT_EQ(verdict.at("differing_pixels"), 0);
    EXPECT_HAS(verdict.at("why").get<std::string>(), "pixel hash");
}

TEST_F(Verify, AFrameOfAnotherSceneTellsWhichKeysDiffer) {
    render({"-f", "2"});
    render({"-f", "2", "-o", "a.png"});
    const std::string change = "layer.dust.render.opacity=0.5";
    for (const char* file : {"frames/shot.0002.exr", "a.png"}) {
        const nlohmann::json verdict = only_verdict(file, {"--set", change});
        EXPECT_EQ(verdict.at("verdict"), "made from another scene");
        EXPECT_EQ(verdict.at("keys"),
                  (nlohmann::json::array(
                      {{{"key", "layer.dust.render.opacity"}, {"frame", "1.0"}, {"scene", "0.5"}}})));
    }
    const RunResult line = verify({"a.png"}, {"--set", change});
    EXPECT_EQ(
        line.out,
        "a.png: made from another scene: layer.dust.render.opacity is 1.0 in the frame, 0.5 in the scene\n");
    write_text(folder / "stars.pda", cube_of_splats(299));
    const nlohmann::json keys = only_verdict("a.png").at("keys");
    ASSERT_EQ(keys.size(), 1u);
    EXPECT_EQ(keys.at(0).at("key"), "layer.stars.source.file");
    EXPECT_HAS(verify({"a.png"}).out, "layer.stars.source.file is a file ");
}

TEST_F(Verify, FramesThatDoNotTellTheirKeysAreVerifiedToo) {
    render({"-f", "2", "-o", "a.png"});
    write_text(folder / "older.png", without_keys(text_of(folder / "a.png")));
    expect_equal({"older.png"});
    EXPECT_EQ(verify({"older.png"}, {"--set", "output.exposure=1"}).out,
              "older.png: made from another scene: the frame does not tell its keys\n");
}

TEST_F(Verify, DamagedAndForeignFilesAreNamedAndTheOthersStillVerified) {
    render({});
    const fs::path two = folder / "frames/shot.0002.exr";
    const std::string bytes = text_of(two);
    write_text(two, bytes.substr(0, bytes.size() - 50));
    write_text(folder / "empty.exr", "");
    write_text(folder / "foreign.ppm", small_picture());
    const RunResult result = verify(
        {"frames/shot.0001.exr", "frames/shot.0002.exr", "empty.exr", "foreign.ppm", "frames/shot.0003.exr"});
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.out,
              "frames/shot.0001.exr: equal\n"
              "frames/shot.0002.exr: damaged: it cannot be read to its last pixel\n"
              "empty.exr: damaged: it cannot be read to its last pixel\n"
              "foreign.ppm: damaged: it does not say which frame of which scene it holds\n"
              "frames/shot.0003.exr: equal\n");
}

TEST_F(Verify, NothingIsStartedWithoutFramesOrAScene) {
    expect_one_line(run({"verify", "scene.toml"}), 2, "FRAME");
    expect_one_line(verify({"missing.exr"}), 2, "missing.exr");
    render({"-f", "1"});
    expect_one_line(run({"verify", "other.toml", "frames/shot.0001.exr"}), 2, "other.toml");
    const std::string before = text_of(folder / "frames/shot.0001.exr");
    const RunResult result = run({"verify", "scene.toml", "frames/shot.0001.exr"},
                                 {.environment = {"TMPDIR=" + (folder / "scene.toml").string()}});
    expect_one_line(result, 4, "temporary");
    EXPECT_EQ(text_of(folder / "frames/shot.0001.exr"), before);
    EXPECT_EQ(names_in("frames").size(), 1u);
}

TEST_F(Verify, LeavesNoFileBehind) {
    render({"-f", "1"});
    fs::create_directories(folder / "temporary");
    expect_success(run({"verify", "scene.toml", "frames/shot.0001.exr"},
                       {.environment = {"TMPDIR=" + (folder / "temporary").string()}}));
    EXPECT_TRUE(names_in("temporary").empty());
    EXPECT_EQ(names_in("frames").size(), 1u);
}

// --resume: frames of this hash stay, missing and damaged ones come, others stop the run before
// its first frame.

class Resume : public SceneTest {
  protected:
    /// Changes whenever the file is replaced.
    ino_t identity(int frame) const {
        struct stat status = {};
        EXPECT_EQ(stat(frame_path(frame).c_str(), &status), 0);
        return status.st_ino;
    }
    fs::path frame_path(int frame) const { return folder / fmt::format("frames/shot.{:04}.exr", frame); }
    /// Hard links keep the old files alive, so that their numbers are not given out again.
    void keep_old_files() {
        fs::create_directories(folder / "old");
        for (const std::string& name : names_in("frames"))
            fs::create_hard_link(folder / "frames" / name, folder / "old" / name);
    }
};

TEST_F(Resume, KeepsWhatIsThereAndRendersWhatIsMissing) {
    expect_success(batch({"-f", "1,3"}));
    keep_old_files();
    const ino_t one = identity(1), three = identity(3);
    expect_success(batch({"--resume"}));
    EXPECT_EQ(identity(1), one);
    EXPECT_EQ(identity(3), three);
    EXPECT_TRUE(fs::exists(frame_path(2)));
    EXPECT_EQ(batch({"--resume"}).code, 0) << "nothing to do is a success";
}

TEST_F(Resume, RendersDamagedFramesAgain) {
    expect_success(batch({"--set", "output.compression=none"}));
    const std::string whole = text_of(frame_path(2));
    write_text(frame_path(2), whole.substr(0, whole.size() / 2));
    write_text(frame_path(3), "");
    const RunResult result = expect_success(batch({"--resume", "--set", "output.compression=none"}));
    EXPECT_HAS(result.err, "shot.0002.exr: damaged");
    EXPECT_EQ(text_of(frame_path(2)), whole);
    EXPECT_GT(text_of(frame_path(3)).size(), 100u);
}

TEST_F(Resume, StopsBeforeTheFirstFrameAtFramesOfOtherSettings) {
    expect_success(batch({"-f", "2"}));
    const std::string before = text_of(frame_path(2));
    expect_one_line(batch({"--resume", "--set", "layer.stars.render.opacity=0.5"}), 2, "shot.0002.exr");
    EXPECT_EQ(names_in("frames").size(), 1u);
    EXPECT_EQ(text_of(frame_path(2)), before);
}

TEST_F(Resume, WithOverwriteReplacesExactlyTheOthers) {
    write_scene(
        "\"layer.stars.render.opacity\" = { keys = [[1, 1.0], [3, 1.0]], interpolation = \"step\" }\n");
    expect_success(batch());
    keep_old_files();
    const ino_t one = identity(1), two = identity(2), three = identity(3);
    write_scene(
        "\"layer.stars.render.opacity\" = { keys = [[1, 1.0], [3, 0.25]], interpolation = \"step\" }\n");
    EXPECT_EQ(batch({"--resume"}).code, 2);
    expect_success(batch({"--resume", "--overwrite"}));
    EXPECT_EQ(identity(1), one) << "a key at frame 3 does not redo frame 1";
    EXPECT_EQ(identity(2), two);
    EXPECT_NE(identity(3), three);
}

TEST_F(Resume, WhatDoesNotReachThePixelsDoesNotCount) {
    expect_success(batch());
    keep_old_files();
    const ino_t one = identity(1);
    expect_success(batch({"--resume", "--set", "output.fps=30", "--set", "provenance.title=Whirlpool", "-t",
                          "1", "--set", "output.compression=piz", "-f", "1-4"}));
    EXPECT_EQ(identity(1), one);
}

TEST_F(Resume, NoticesChangedInputs) {
    expect_success(batch({"-f", "1"}));
    write_text(folder / "stars.pda", cube_of_splats(299));
    EXPECT_EQ(batch({"-f", "1", "--resume"}).code, 2);
    write_text(folder / "stars.pda", cube_of_splats(300));
    expect_success(batch({"-f", "1", "--resume"}));
}

TEST_F(Resume, ForeignPicturesAreNeverReplacedUnasked) {
    expect_success(batch({"-f", "1", "-o", "f.####.png", "--region", "0,0,32,24"}));
    EXPECT_EQ(batch({"-f", "1", "-o", "f.####.png", "--resume"}).code, 2)
        << "another region is another frame";
}

// status: what --resume would keep, render and refuse, as counts and ranges, without touching anything.

class Status : public SceneTest {
  protected:
    RunResult status(Words more = {}) const { return run(joined({"status", "scene.toml"}, more)); }
    nlohmann::json eyes(Words more = {}) const {
        more.push_back("--json");
        return nlohmann::json::parse(status(more).out).at("eyes");
    }
    /// Without those that name scene and files, and what has drawn them, which is this machine's.
    static std::string lines(const RunResult& result) {
        std::istringstream all(result.out);
        std::string kept;
        int number = 0;
        for (std::string line; std::getline(all, line);)
            if (++number > 2 && line.find("drawn by ") == std::string::npos) kept += line + "\n";
        return kept;
    }
    /// Names, sizes, times of change and contents of all below the folder.
    std::string everything() const {
        std::set<std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            std::string line = entry.path().string();
            line += fmt::format(" {}", entry.last_write_time().time_since_epoch().count());
            if (entry.is_regular_file()) line += text_of(entry.path());
            files.insert(line);
        }
        return fmt::format("{}", fmt::join(files, "\n"));
    }
    std::string frame(int number) const { return fmt::format("frames/shot.{:04}.exr", number); }
};

TEST_F(Status, NamesFramesDoneMissingDamagedAndForeign) {
    expect_success(batch({"-q", "-f", "1-12"}));
    for (const int missing : {2, 3, 4, 7, 9, 11}) fs::remove(folder / frame(missing));
    const std::string whole = text_of(folder / frame(6));
    write_text(folder / frame(6), whole.substr(0, whole.size() / 2));
    expect_success(batch({"-q", "-f", "12", "--overwrite", "--set", "layer.dust.render.opacity=0.5"}));
    const std::string before = everything();
    const RunResult result = status({"-f", "1-12"});
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out.substr(0, result.out.find("done ")),
              fmt::format("scene scene.toml\nframes {}/frames/shot.####.exr\n", folder.string()));
    EXPECT_EQ(lines(result), "done 4 of 12: 1,5,8,10\nmissing 6: 2-4,7-11x2\ndamaged 1: 6\nforeign 1: 12\n");
    EXPECT_EQ(everything(), before);
    // --resume does with the others as it says.
    expect_success(batch({"-q", "-f", "1-12", "--resume", "--overwrite"}));
    const RunResult all = expect_success(status({"-f", "1-12"}));
    EXPECT_EQ(lines(all), "done 12 of 12: 1-12\n");
}

/// Which is kept beside the file: its bytes are the same whatever drew it.
TEST_F(Status, SaysWhatDrewEachFrame) {
    expect_success(batch({"-q", "-f", "1-3", "--device", "cpu"}));
    const fs::path second = folder / frame(2);
    if (getxattr(second.c_str(), "user.astrosplat.device", nullptr, 0) <= 0)
        GTEST_SKIP() << "the file system keeps no attributes";
    const std::string by_cpu = text_of(second);
    EXPECT_HAS(status({"-f", "1-3"}).out, "drawn by cpu: 1-3\n");
    const RunResult by_gpu =
        batch({"-q", "-f", "2", "--overwrite", "--device", "gpu", "--stats", "stats.json"});
    if (by_gpu.err.starts_with("astrosplat: error: --device gpu: ")) GTEST_SKIP() << by_gpu.err;
    expect_success(by_gpu);
    EXPECT_EQ(text_of(second) == by_cpu, true) << "byte for byte";
    const std::string card = json("stats.json").at("frames").at(0).at("device");
    EXPECT_NE(card, "cpu");
    const std::string said = expect_success(status({"-f", "1-3"})).out;
    EXPECT_HAS(said, "drawn by cpu: 1,3\n");
    EXPECT_HAS(said, "drawn by " + card + ": 2\n");
    EXPECT_EQ(eyes({"-f", "1-3"})[0].at("drawn_by"), (nlohmann::json{{"cpu", "1,3"}, {card, "2"}}));
    fs::remove(second);
    EXPECT_EQ(status({"-f", "1-3"}).out.find(card), std::string::npos);
}

TEST_F(Status, CreatesNoFolder) {
    const std::string before = everything();
    const RunResult result = status();
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(lines(result), "done 0 of 3\nmissing 3: 1-3\n");
    EXPECT_EQ(everything(), before);
}

TEST_F(Status, TellsEyesApart) {
    const Words pair = {"-o", "%V/shot.##.exr", "--set", "camera.eye_separation=0.5"};
    const auto with = [&](Words more) {
        more.insert(more.end(), pair.begin(), pair.end());
        return more;
    };
    expect_success(batch(with({"-q", "-f", "1-4"})));
    fs::remove(folder / "right/shot.02.exr");
    fs::remove(folder / "right/shot.03.exr");
    write_text(folder / "left/shot.04.exr", "");
    EXPECT_EQ(lines(status(with({"-f", "1-4"}))),
              "left done 3 of 4: 1-3\nleft damaged 1: 4\nright done 2 of 4: 1,4\nright missing 2: 2-3\n");
    const nlohmann::json eyes = this->eyes(with({"-f", "1-4"}));
    ASSERT_EQ(eyes.size(), 2u);
    EXPECT_EQ(eyes[0].at("eye"), "left");
    EXPECT_EQ(eyes[0].at("damaged"), (nlohmann::json{{"count", 1}, {"frames", "4"}}));
    EXPECT_EQ(eyes[1].at("missing"), (nlohmann::json{{"count", 2}, {"frames", "2-3"}}));
    EXPECT_EQ(eyes[1].at("foreign"), (nlohmann::json{{"count", 0}, {"frames", ""}}));
}

TEST_F(Status, TakesWhatBatchWasGiven) {
    const Words smaller = {"--resolution", "50%", "--layers", "dust", "--region", "4,4,16,12"};
    Words quiet = smaller;
    quiet.push_back("-q");
    expect_success(batch(quiet));
    expect_success(status(smaller));
    const RunResult other = status();
    EXPECT_EQ(other.code, 3);
    EXPECT_EQ(lines(other), "done 0 of 3\nforeign 3: 1-3\n");
    const nlohmann::json report = nlohmann::json::parse(status({"--json"}).out);
    EXPECT_EQ(report.at("complete"), false);
    EXPECT_EQ(report.at("output"), (folder / "frames/shot.####.exr").string());
    Words as_json = smaller;
    as_json.push_back("--json");
    EXPECT_EQ(nlohmann::json::parse(status(as_json).out).at("complete"), true);
}

TEST_F(Status, WhatIsNoFrameIsForeign) {
    write_text(folder / "strange.####.ppm", "");
    fs::create_directories(folder / "frames/shot.0001.exr");
    fs::create_symlink("nowhere", folder / frame(2));
    EXPECT_EQ(lines(status()), "done 0 of 3\nmissing 1: 3\ndamaged 1: 2\nforeign 1: 1\n");
}

TEST_F(Status, BadInputIsOneLine) {
    expect_one_line(run({"status"}), 2, "SCENE");
    expect_one_line(run({"status", "other.toml"}), 2, "other.toml");
    expect_one_line(status({"--layers", "gas"}), 2, "gas");
    fs::remove(folder / "stars.pda");
    expect_one_line(status(), 2, "stars.pda");
}

}  // namespace
}  // namespace astrosplat::test
