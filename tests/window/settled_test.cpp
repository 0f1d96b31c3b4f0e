// The settled picture is the frame of --batch, and a set is seen while it grows.

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "output/write.h"
#include "source/texture.h"
#include "support/color_config.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

// The settled picture is the very frame that --batch computes.

class Settled : public ViewerTest {
  protected:
    Settled() {
        write_text(scene_file, R"(astrosplat = 1
[output]
frames = "1-24"
depth = "float"
[camera]
position = [0.0, 6.0, 8.0]
target = [0.0, 0.0, 0.0]
[[layer]]
name = "disc"
[layer.source]
meshes = [ { mesh = "relief", texture = "rings.png" } ]
count = 30000
[layer.render]
blend = "screen"
[[layer]]
name = "glow"
[layer.source]
meshes = [ { mesh = "sphere", texture = "rings.png" } ]
count = 10000
[layer.render]
blend = "add"
opacity = 0.5
[animation]
"camera.position" = { keys = [[1, [0.0, 6.0, 8.0]], [24, [4.0, 5.0, 7.0]]] }
"layer.disc.look.alpha.power" = { keys = [[1, 1.0], [24, 2.0]] }
)");
    }
    std::string shot(const std::string& frame) const {
        const std::string file = "shot" + frame + ".exr";
        expect_success(run({"--screenshot", file, "--settled", "--size", "200x120", "--frame", frame,
                            scene_file.string(), "--no-cache"}));
        return file;
    }
    void expect_batch() const {
        expect_success(run({"--batch", scene_file.string(), "-f", "1,13", "--resolution", "200x120", "-o",
                            "batch##.exr", "--stats", "stats.json", "--no-cache"}));
        const nlohmann::json stats = nlohmann::json::parse(text_of(folder / "stats.json"));
        const std::vector<std::string> frames = {"1", "13"};
        std::vector<std::string> hashes;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const Image settled = load_linear_image(folder / shot(frames[i]));
            const Image batch = load_linear_image(folder / (i == 0 ? "batch01.exr" : "batch13.exr"));
            ASSERT_EQ(settled.width, 200);
            ASSERT_EQ(settled.height, 120);
            ASSERT_EQ(settled.pixels.size(), batch.pixels.size());
            EXPECT_EQ(std::memcmp(settled.pixels.data(), batch.pixels.data(),
                                  settled.pixels.size() * sizeof(float)),
                      0)
                << "frame " << frames[i];
            hashes.push_back(pixel_hash(settled));
            EXPECT_EQ(hashes.back(), stats.at("frames").at(i).at("sha256").get<std::string>());
        }
        EXPECT_NE(hashes[0], hashes[1]) << "the frames must differ for this test to say anything";
    }
};

TEST_F(Settled, EqualsBatchBitForBit) { expect_batch(); }

// The viewport's transform is OpenColorIO's for OpenGL, the file's that for processors.
TEST_F(Settled, LooksAsTheFileThroughAConfiguration) {
    write_color_config(folder);
    replace_in_scene("depth = \"float\"", "ocio = { config = \"colors.ocio\" }\nexposure = 1");
    expect_success(run(
        {"--screenshot", "shot.png", "--settled", "--size", "200x120", scene_file.string(), "--no-cache"}));
    expect_success(run({"--batch", scene_file.string(), "-f", "1", "--resolution", "200x120", "-o",
                        "batch.png", "--no-cache"}));
    const Image shot = load_raw_image(folder / "shot.png"), batch = load_raw_image(folder / "batch.png");
    ASSERT_EQ(shot.width, batch.width);
    int bright = 0;
    for (std::int64_t y = 0; y < shot.height; ++y)
        for (std::int64_t x = 0; x < shot.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float seen = 255.0f * shot.at(x, y)[c], filed = 255.0f * batch.at(x, y)[c];
                ASSERT_NEAR(seen, filed, 1.01f) << x << " " << y << " " << c;  // one of them is dithered
                bright += filed > 100.0f;
            }
    EXPECT_GT(bright, 1000);
}

TEST_F(Settled, EqualsBatchWithTheCameraOfAFile) {
    write_text(folder / "cam.chan", "1 0 6 8 -30 0 0 40\n24 4 5 7 -30 20 0 60\n");
    replace_in_scene("target", "file = \"cam.chan\"\ntarget");
    expect_batch();
}

TEST_F(Settled, TheWidgetsAreInAScreenshotThatAsksForThem) {
    expect_success(run({"--screenshot", "window.png", "--ui", "--settled", "--size", "900x600",
                        scene_file.string(), "--no-cache"}));
    const Image window = load_raw_image(folder / "window.png");
    ASSERT_EQ(window.width, 900);
    ASSERT_EQ(window.height, 600);
    const auto reds = [&](std::int64_t x0, std::int64_t x1, std::int64_t y0, std::int64_t y1) {
        std::set<float> found;
        for (std::int64_t y = y0; y < y1; ++y)
            for (std::int64_t x = x0; x < x1; ++x) found.insert(window.at(x, y)[0]);
        return found;
    };
    EXPECT_EQ(reds(500, 880, 2, 4).size(), 1u) << "the menu bar's background";
    EXPECT_GT(*reds(500, 880, 2, 4).begin(), 0.0f);
    EXPECT_GT(reds(0, 300, 4, 24).size(), 8u) << "the menus' names";
}

TEST_F(Settled, APreviewsLightCanBeSavedToo) {
    expect_success(run({"--batch", scene_file.string(), "-f", "1", "--resolution", "200x120", "-o",
                        "batch.exr", "--no-cache", "--set", "output.depth=float"}));
    const Image batch = load_linear_image(folder / "batch.exr");
    double largest = 0.0, sum = 0.0;
    for (const float value : batch.pixels) largest = std::max(largest, double(value)), sum += value;
    for (const std::string engine : {"", "--opengl"}) {
        std::vector<std::string> words = {"--screenshot",      "preview.exr", "--size",
                                          "200x120",           "--frame",     "1",
                                          scene_file.string(), "--no-cache"};
        if (!engine.empty()) words.push_back(engine);
        expect_success(run(words));
        const Image preview = load_linear_image(folder / "preview.exr");
        ASSERT_EQ(preview.width, 200);
        ASSERT_EQ(preview.height, 120);
        double difference = 0.0;
        ASSERT_EQ(preview.pixels.size(), batch.pixels.size());
        for (std::size_t i = 0; i < preview.pixels.size(); ++i)
            difference += std::abs(double(preview.pixels[i]) - double(batch.pixels[i]));
        EXPECT_LT(difference, 0.05 * sum) << "the same way up, in linear light " << engine;
    }
}

class WindowGrowth : public WindowTest {
  protected:
    /// A set that takes seconds.
    void SetUp() override {
        WindowTest::SetUp();
        replace_in_scene("count = 60000", "count = 20000000");
    }
    /// More than the words over the picture.
    bool something_is_seen() const {
        const Pixels seen = frame_pixels();
        const auto is_lit = [](std::uint32_t rgb) {
            return std::max({rgb >> 16 & 0xff, rgb >> 8 & 0xff, rgb & 0xff}) > 60;
        };
        return std::count_if(seen.rgb.begin(), seen.rgb.end(), is_lit) > 3000;
    }
};

TEST_F(WindowGrowth, APartOfTheSetIsSeenBeforeItIsWhole) {
    start({scene_file.string(), "--no-cache", "--threads", "1"});
    ASSERT_TRUE(comes_true([&] { return something_is_seen(); }));
    // Escape gives up what is being generated, and leaves alone what is whole: nothing goes on until it is
    // pressed.
    stop();
    person->press("Escape");
    go_on();
    EXPECT_TRUE(comes_true([&] { return !something_is_seen(); })) << "what was given up stays in the picture";
    EXPECT_TRUE(running());
}

}  // namespace
}  // namespace astrosplat::test
