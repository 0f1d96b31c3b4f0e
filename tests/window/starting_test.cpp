// Starting the window: its scale, slow frames, and refusals in one line.
#include "edit/edits.h"
#include "edit/preferences.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

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
    for (const std::string& part : parts)
        EXPECT_NE(result.err.find(part), std::string::npos) << part << " in " << result.err;
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
