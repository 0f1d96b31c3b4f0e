// verify: each of its four verdicts, for every format, pairs, parts of frames, and frames of older versions.
#include <cmath>
#include <cstring>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

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
    const double before = static_cast<double>(value);
    value = static_cast<float>(before + 2.5);
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

}  // namespace
}  // namespace astrosplat::test
