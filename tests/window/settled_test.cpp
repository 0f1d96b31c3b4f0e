// From the start of the window to its settled picture.
#include <nlohmann/json.hpp>

#include "edit/edits.h"
#include "edit/preferences.h"
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
    for (const std::string device : {"cpu", "gpu"}) {
        std::vector<std::string> words = {
            "--screenshot",      "preview.exr", "--size",   "200x120", "--frame", "1",
            scene_file.string(), "--no-cache",  "--device", device};
        expect_success(run(words));
        const Image preview = load_linear_image(folder / "preview.exr");
        ASSERT_EQ(preview.width, 200);
        ASSERT_EQ(preview.height, 120);
        double difference = 0.0;
        ASSERT_EQ(preview.pixels.size(), batch.pixels.size());
        for (std::size_t i = 0; i < preview.pixels.size(); ++i)
            difference += std::abs(double(preview.pixels[i]) - double(batch.pixels[i]));
        EXPECT_LT(difference, 0.05 * sum) << "the same way up, in linear light, " << device;
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
    // Escape gives up what is being generated, and leaves alone what is whole: nothing goes on until
    // it is pressed.
    stop();
    person->press("Escape");
    go_on();
    EXPECT_TRUE(comes_true([&] { return !something_is_seen(); })) << "what was given up stays in the picture";
    EXPECT_TRUE(running());
}

// A screen of many small pixels: the window is as large to the eye as on any other.

class WindowScale : public WindowTest {
  protected:
    /// The window's size on a screen of that size whose desktop asks for scale 2, and what is kept of it.
    Area opened_on(int screen_width, int screen_height) {
        screen.emplace(screen_width, screen_height);
        person.emplace(screen->display());
        screen->set_dpi(192);
        start();
        const Area area = screen->window_area();
        person->press("ctrl+q");
        EXPECT_TRUE(comes_true([&] { return !running(); }));
        kept = load_preferences(folder / "home/config/astrosplat/viewer.json");
        return area;
    }
    Preferences kept;
};

TEST_F(WindowScale, IsThatOfTheScreen) {
    const Area area = opened_on(2 * width + 100, 2 * height + 100);
    EXPECT_EQ(area.width, 2 * width);
    EXPECT_EQ(area.height, 2 * height);
    EXPECT_EQ(kept.window_width, width);
    EXPECT_EQ(kept.window_height, height);
}

TEST_F(WindowScale, IsNoReasonToBeLargerThanTheScreen) {
    const Area area = opened_on(2 * width - 400, height);
    EXPECT_EQ(area.width, 2 * width - 400);
    EXPECT_EQ(area.height, height);
}

// Input during one long frame takes effect afterwards, in its order.

class WindowSlow : public WindowTest {};

TEST_F(WindowSlow, AValueIsKeyedAtTwoFramesBlindly) {
    const Pixels first = start_settled();
    TestWindow& widgets = same_widgets();
    const float y = widgets.at("ruler").y, from = widgets.at("keyframe camera.position 1").x,
                to = widgets.at("keyframe camera.position 24").x;
    stop();
    person->click(diamond(power));
    person->drag({from, y}, {to - from, 0.0f});
    person->move({from, y});
    person->double_click(value_box(power));
    person->type("3.25");
    person->press("Return");
    person->press("ctrl+s");
    EXPECT_EQ(frame_pixels(), first);
    go_on();
    const auto keyframes = [&] {
        const Scene scene = saved();
        const Track* track = find_track(scene, power);
        return track ? track->keyframes : decltype(Track::keyframes)();
    };
    ASSERT_TRUE(comes_true([&] { return keyframes().size() == 2; })) << "it was not saved, or not as it was";
    EXPECT_EQ(keyframes()[0].frame, 1.0);
    EXPECT_EQ(keyframes()[0].value, std::vector<double>{1.0});
    EXPECT_EQ(keyframes()[1].frame, 24.0);
    EXPECT_EQ(keyframes()[1].value, std::vector<double>{3.25});
}

// One line and an exit code where the window or the screenshot cannot be had.

void expect_line(const RunResult& result, int code, const std::vector<std::string>& parts) {
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& part : parts) EXPECT_HAS(result.err, part);
    EXPECT_EQ(result.out, "");
}

class NoWindow : public ViewerTest {};

TEST_F(NoWindow, WithoutADisplayBatchIsNamed) {
    expect_line(run({scene_file.string()}), 2, {"no window", "--batch", "--screenshot"});
}

TEST_F(NoWindow, ScreenshotOptionsAreChecked) {
    const std::string scene = scene_file.string();
    const auto shot = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {scene, "--no-cache", "--screenshot"});
        return run(words);
    };
    expect_line(shot({"a.jpg"}), 2, {"--screenshot", ".png", "a.jpg"});
    expect_line(shot({"a.exr", "--settled", "--ui"}), 2, {"--screenshot", "--ui"});
    expect_line(shot({"a.png", "--size", "960"}), 2, {"--size", "960x540", "'960'"});
    expect_line(shot({"a.png", "--size", "8x8"}), 2, {"--size", "16x16", "'8x8'"});
    expect_line(shot({"a.png", "--frame", "one"}), 2, {"--frame", "'one'"});
    expect_line(shot({"a.png", "--batch"}), 2, {"--screenshot"});
    expect_line(run({"--screenshot", "a.png", "missing.toml"}), 2, {"missing.toml"});
    expect_line(shot({scene + "/a.png", "--size", "64x36", "-q"}), 4, {scene_file.filename().string()});
    EXPECT_FALSE(fs::exists(folder / "a.png"));
}

TEST_F(NoWindow, ATomlWithoutLayersIsSaidToHaveNone) {
    const auto shot = [&](const std::string& name, const std::string& text) {
        write_text(folder / name, text);
        return run({name, "--no-cache", "--screenshot", "a.png"});
    };
    expect_line(shot("empty.toml", ""), 2, {"empty.toml", "astrosplat = 1", "found an empty file"});
    expect_line(shot("other.toml", "[package]\nname = \"x\"\n"), 2, {"other.toml", "astrosplat = 1"});
    expect_line(shot("none.toml", "astrosplat = 1\n[output]\nfps = 24.0\n"), 2,
                {"none.toml", "expected at least one [[layer]], found none"});
    expect_line(shot("look.toml", "[look]\nradius = { min = 1.0, max = 2.0 }\n"), 2,
                {"look.toml", "[[layer]]", "found a look", "Apply look"});
    expect_line(run({"none.toml", "--batch"}), 2,
                {"none.toml", "expected at least one [[layer]], found none"});
    EXPECT_FALSE(fs::exists(folder / "a.png"));
}

class WindowRefused : public WindowTest {};

TEST_F(WindowRefused, AnOldOpenGlIsSaidToBeTooOld) {
    environment = {"MESA_GL_VERSION_OVERRIDE=3.3", "MESA_GLSL_VERSION_OVERRIDE=330"};
    expect_line(run_program({ASTROSPLAT_PROGRAM, scene_file.string()}, options()), 2,
                {"no window", "--batch"});
}

TEST_F(WindowRefused, AWrongFileIsSaidInOneLine) {
    const auto open = [&](const std::string& file) {
        return run_program({ASTROSPLAT_PROGRAM, file}, options());
    };
    expect_line(open("missing.toml"), 2, {"missing.toml"});
    write_text(folder / "wrong.toml",
               "astrosplat = 1\n[output]\nresolutoin = [1, 1]\n[[layer]]\nname = \"a\"\n");
    expect_line(open("wrong.toml"), 2, {"wrong.toml", "resolutoin"});
    write_text(folder / "notes.txt", "no scene");
    expect_line(open("notes.txt"), 2, {"notes.txt"});
}

}  // namespace
}  // namespace astrosplat::test
