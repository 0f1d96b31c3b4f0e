// The view by hand: looking around, selecting, handles, the camera's path; and pictures to compare with.
#include "edit/edits.h"
#include "edit/placement.h"
#include "gui/widgets.h"
#include "output/metadata.h"
#include "source/texture.h"
#include "source/write_image.h"
#include "support/color_config.h"
#include "support/test.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

// Looking around leaves the scene alone, and an untouched window rests.

class WindowView : public WindowTest {};

TEST_F(WindowView, OrbitGoesToAFreeViewAndZeroReturns) {
    const Pixels before = start_settled();
    const Pixels tools = pixels_of(&Layout::tools);
    person->drag(same_widgets().at("frame in view"), {120.0f, 40.0f});
    settled_frame(before);
    EXPECT_NE(pixels_of(&Layout::tools), tools) << "the view is still called Camera";
    EXPECT_EQ(title(), "scene.toml - astrosplat") << "looking around is no edit";
    person->press("0");
    expect_settled(before);
    EXPECT_EQ(pixels_of(&Layout::tools), tools);
}

/// User and system time of a process, seconds.
double processor_seconds(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(in, text);
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string skipped;
    for (int field = 3; field < 14; ++field) fields >> skipped;
    double user = 0.0, system = 0.0;
    fields >> user >> system;
    return (user + system) / double(sysconf(_SC_CLK_TCK));
}

// Time of the processor, not of the clock: what else the machine does counts little. A window that drew
// frame after frame would need all of it.
TEST_F(WindowView, AnIdleWindowRests) {
    const Pixels before = start_settled();
    constexpr double while_s = 3.0, most_s = 0.5;
    const double begin = processor_seconds(program->id());
    usleep(static_cast<useconds_t>(while_s * 1e6));
    const double used = processor_seconds(program->id()) - begin;
    std::printf("idle window: %.1f %% of one core\n", 100.0 * used / while_s);
    EXPECT_LT(used, most_s);
    EXPECT_EQ(frame_pixels(), before);
}

// A click in the picture selects the layer that is seen there.

/// Two flat squares side by side, and a dimmer one behind the right one.
class WindowSelect : public WindowTest {
  protected:
    WindowSelect() {
        write_plain(folder / "grey.png", 16, 16, {200, 200, 200});
        write_text(scene_file, R"(astrosplat = 1
[output]
resolution = [320, 180]
frames = "1"
[camera]
position = [0.0, 30.0, 0.0]
)" + layer("left", "[-7.0, 0.0, 0.0]", "1.0") +
                                   layer("right", "[7.0, 0.0, 0.0]", "1.0") +
                                   layer("behind", "[7.0, -3.0, 0.0]", "0.2"));
    }
    static std::string layer(const std::string& name, const std::string& place, const std::string& gain) {
        return "[[layer]]\nname = \"" + name + "\"\n[layer.transform]\ntranslate = " + place +
               "\n[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"grey.png\" } ]\ncount = 4000\n" +
               "[layer.look]\ngrade = { gain = " + gain + " }\n[layer.render]\nblend = \"add\"\n";
    }
    glm::vec2 row(int index) const {  // of the list of layers
        const Rect panel = layout().panel;
        return {panel.x + 100.0f, panel.y + 32.0f + 28.0f * (float(index) + 0.5f)};
    }
    Area list_area() const {
        const Rect panel = layout().panel;
        return {int(panel.x), int(panel.y), int(panel.width), 32 + 3 * 28};
    }
    /// The list, seen with the mouse elsewhere.
    Pixels list() const {
        person->move({width - 2.0f, height - 2.0f});
        return screen->pixels(list_area());
    }
    Pixels list_after_click_on_row(int index) {
        const Pixels before = list();
        person->click(row(index));
        comes_true([&] { return list() != before; });
        return list();
    }
    glm::vec2 in_view(float right) const {  // of the middle, shares of the height
        const Rect area = layout().viewport;
        return {area.x + 0.5f * area.width + right * area.height, area.y + 0.5f * area.height};
    }
};

TEST_F(WindowSelect, AClickSelectsAndAnotherTakesTheOneBehind) {
    start_settled();
    const Pixels left = list();
    const Pixels behind = list_after_click_on_row(2), right = list_after_click_on_row(1);
    ASSERT_NE(left, right);
    ASSERT_NE(left, behind);
    person->click(in_view(-0.2f));
    EXPECT_TRUE(comes_true([&] { return list() == left; })) << "the left square is clicked";
    person->click(in_view(0.2f));
    EXPECT_TRUE(comes_true([&] { return list() == right; })) << "the brighter one of two";
    usleep(700'000);  // no double click
    person->click(in_view(0.2f));
    EXPECT_TRUE(comes_true([&] { return list() == behind; })) << "the one behind it";
    EXPECT_EQ(title(), "scene.toml - astrosplat") << "selecting is no edit";
}

/// The camera, 30 scene units over the squares, has a focus.
class WindowFocus : public WindowSelect {
  protected:
    WindowFocus() { replace_in_scene("[camera]\n", "[camera]\nf_number = 8.0\n"); }
    void pick() const {
        person->press("ctrl+k");
        person->type("pick the focus");
        person->press("Return");
        usleep(300'000);
    }
};

TEST_F(WindowFocus, IsPickedInThePicture) {
    start_settled();
    const std::string untouched = title();
    pick();
    person->press("Escape");
    person->click(in_view(-0.2f));  // selects
    usleep(700'000);
    pick();
    person->click(in_view(0.0f));  // nothing is there
    usleep(700'000);
    EXPECT_EQ(title(), untouched);
    person->click(in_view(-0.2f));
    EXPECT_TRUE(comes_true([&] { return title() != untouched; }));
    save();
    EXPECT_NEAR(saved().camera.focus_distance, 30.0, 0.6);
    person->press("ctrl+z");
    EXPECT_TRUE(comes_true([&] { return title() != untouched; }));
    save();
    EXPECT_EQ(saved().camera.focus_distance, 0.0);
}

// A layer is moved by its handles in the picture, and a crop cuts it.

class WindowHandles : public WindowTest {
  protected:
    /// Where the scene's camera shows a point at frame 1, px of the window.
    glm::vec2 at(const glm::dvec3& point) const {
        const Rect viewport = layout().viewport;
        const OutputParams output = saved().output;
        const double aspect = double(output.width) / double(output.height);
        const double high = std::min(double(viewport.height), double(viewport.width) / aspect);
        const Rect place =
            place_frame(ViewState(), viewport, int(std::lround(high * aspect)), int(std::lround(high)));
        const Camera camera = make_camera(saved().camera, double(place.width), double(place.height), {});
        return glm::vec2(place.x, place.y) + *project_point(camera, point);
    }
};

TEST_F(WindowHandles, ALayerIsDraggedUndoneAndSaved) {
    const Pixels before = start_settled();
    person->press("w");
    person->drag(at({0.0, 0.0, 0.0}), at({1.0, 0.0, 0.0}) - at({0.0, 0.0, 0.0}));
    expect_title("scene.toml - edited");
    save();
    EXPECT_NEAR(saved().layers[0].transform.translate.x, 1.0, 0.05);
    person->press("ctrl+z");
    expect_title("scene.toml - edited");
    person->press("w");
    expect_settled(before);
}

TEST_F(WindowHandles, APartIsErasedUndoneAndSaved) {
    const Pixels before = start_settled();
    person->press("m");
    const glm::vec2 from = at({-1.0, 0.0, 0.0}), to = at({1.0, 0.0, 1.5});
    person->drag(from, to - from);
    expect_title("scene.toml - edited");
    save();
    const std::vector<Crop> crops = saved().layers[0].look.crop;
    ASSERT_EQ(crops.size(), 1u);
    EXPECT_EQ(crops[0].keep, Crop::Keep::outside);
    EXPECT_EQ(outline_lines(crops[0].outline).at(0).size(), 4u) << crops[0].outline;
    person->press("ctrl+z");
    expect_title("scene.toml - edited");
    person->press("m");
    expect_settled(before);
}

TEST_F(WindowHandles, ADragBesideThemOrbits) {
    start_settled();
    person->press("w");
    person->drag(at({0.0, 0.0, 0.0}) + glm::vec2(0.0f, 200.0f), {60.0f, 0.0f});
    const Pixels tools = pixels_of(&Layout::tools);
    person->press("0");
    EXPECT_TRUE(comes_true([&] { return pixels_of(&Layout::tools) != tools; })) << "it was a free view";
    EXPECT_EQ(title(), "scene.toml - astrosplat");
}

// The camera's path by hand: a keyframe is dragged in the view, and frames that are rendered are played.

class WindowPath : public WindowTest {
  protected:
    /// Keyframes that a view from above shows, at frames 1 and 24.
    void write_low_path() {
        replace_in_scene("[[1, [0.0, 6.0, 8.0]], [24, [4.0, 5.0, 7.0]]]",
                         "[[1, [0.0, 6.0, 2.0]], [24, [3.0, 5.0, 2.0]]]");
    }
    /// The middle of a point of the path at another frame than the one that is seen.
    std::optional<glm::vec2> point_on_path() const {
        const Rect area = layout().viewport;
        const Pixels seen = frame_pixels();
        const auto is_key = [&](int x, int y) {
            return seen.rgb[std::size_t(y * seen.width + x)] == 0xD9A441;
        };
        for (int y = 0; y + 7 < seen.height; ++y)
            for (int x = 0; x + 7 < seen.width; ++x) {
                bool square = true;
                for (int i = 0; i < 49 && square; ++i) square = is_key(x + i % 7, y + i / 7);
                if (square) return glm::vec2(area.x, area.y) + glm::vec2(x + 3, y + 3);
            }
        return std::nullopt;
    }
    /// All of a finished frame.
    void write_frame(int frame, unsigned char level) {
        fs::create_directories(folder / "frames");
        write_plain(folder / fmt::format("frames/shot.{:04}.png", frame), 320, 180, {level, level, level});
    }
    /// Frame 1 lies there as light of 0.2, and one stop of exposure.
    void show_rendered_light(const std::string& view) {
        replace_in_scene("shot.####.png", "shot.####.exr");
        replace_in_scene("frames = ", view + "\nexposure = 1.0\nframes = ");
        fs::create_directories(folder / "frames");
        write_linear_image(folder / "frames/shot.0001.exr", make_image(320, 180, 4, 0.2f), "",
                           Existing::replace);
        start_settled();
        person->click(same_widgets().at("playing/Rendered"));
    }
    bool sees(unsigned char level) const {
        return count_of(frame_pixels(), IM_COL32(level, level, level, 255)) > 10'000;
    }
};

TEST_F(WindowPath, AKeyframeIsDraggedInTheView) {
    write_low_path();
    const Pixels camera = start_settled();
    person->press("7");
    settled_frame(camera);
    const std::optional<glm::vec2> point = point_on_path();
    ASSERT_TRUE(point);
    person->drag(*point, {80.0f, 0.0f});
    expect_title("scene.toml - edited");
    save();
    const Scene scene = saved();
    const std::vector<double>& moved = find_track(scene, "camera.position")->keyframes[1].value;
    EXPECT_GT(moved[0], 3.5);
    EXPECT_NEAR(moved[1], 5.0, 1e-3);
    EXPECT_NEAR(moved[2], 2.0, 0.2);
    person->press("ctrl+z");
    person->press("ctrl+s");
    EXPECT_TRUE(
        comes_true([&] { return find_track(saved(), "camera.position")->keyframes[1].value[0] == 3.0; }));
}

TEST_F(WindowPath, RenderedFramesAreShownAndTheOthersAsPreviews) {
    write_frame(1, 100);
    write_frame(24, 200);
    start_settled();
    person->click(same_widgets().at("playing/Rendered"));
    EXPECT_TRUE(comes_true([&] { return sees(100); }));
    person->press("ctrl+Right");
    EXPECT_TRUE(comes_true([&] { return sees(200); }));
    person->press("Left");
    EXPECT_TRUE(comes_true([&] { return !sees(200) && !sees(100); })) << "frame 23 is not rendered";
    write_frame(23, 150);
    EXPECT_TRUE(comes_true([&] { return sees(150); })) << "and now it is";
}

/// Each is made once; what is edited and undone finds them all again.
TEST_F(WindowPath, FinalFramesPlayFromMemory) {
    start_settled();
    const auto line = [&] { return count_of(pixels_of(&Layout::timeline), color::accent); };
    const int one = line(), all = int(1.6f * layout().timeline.width);  // two rows of px over the numbers
    EXPECT_LT(one, all / 2);
    person->click(same_widgets().at("playing/Final"));
    person->press("space");
    EXPECT_TRUE(comes_true([&] { return line() > all; })) << "every frame is waited for";
    person->press("space");
    person->drag(value_box(power), {40.0f, 0.0f});
    expect_title("scene.toml - edited");
    EXPECT_TRUE(comes_true([&] { return line() < all / 2; })) << "none of them is as it would be now";
    person->press("ctrl+z");
    EXPECT_TRUE(comes_true([&] { return line() > all; }));
    EXPECT_TRUE(settled());
}

/// Frames of scene light are seen through the viewport's exposure and view, as the preview is.
TEST_F(WindowPath, RenderedLightIsShownThroughTheView) {
    show_rendered_light("view = \"linear\"");
    EXPECT_TRUE(comes_true([&] { return sees(102); })) << "2 * 0.2 of 255";
}

TEST_F(WindowPath, RenderedLightIsShownThroughOpenColorIO) {
    write_color_config(folder);
    show_rendered_light("ocio = { config = \"colors.ocio\", display = \"Screen\", view = \"Film\" }");
    EXPECT_TRUE(comes_true([&] { return sees(161); })) << "the root of 2 * 0.2, of 255";
}

// Two looks one after the other, and the output's own pixels.

class WindowCompare : public WindowTest {};

TEST_F(WindowCompare, AShowsTheStoredLookAndTheOneAtHand) {
    const Pixels stored = start_settled();
    person->press("b");
    person->drag(value_box(power), {60.0f, 0.0f});
    const Pixels changed = settled_frame(stored);
    person->press("a");
    expect_settled(stored);
    person->press("a");
    expect_settled(changed);
    expect_title("scene.toml - edited");
}

/// The ground of a signed difference is what no picture of the scene has.
TEST_F(WindowCompare, DShowsWhereTheFrontDiffersAndThePictureAgain) {
    const Pixels before = start_settled();
    constexpr std::uint32_t ground = IM_COL32(18, 18, 22, 255);
    ASSERT_EQ(count_of(before, ground), 0);
    person->press("d");
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), ground) > 1000; })) << program->err_so_far();
    person->press("d");
    expect_settled(before);
}

/// Of a picture larger than the viewport its middle, pixel by pixel as it will be in the file.
TEST_F(WindowCompare, OutputPixelsAreThoseOfTheFrame) {
    replace_in_scene("[320, 180]", "[1600, 1200]");
    const Pixels fitted = start_settled();
    person->press("z");
    const Pixels shown = settled_frame(fitted);
    expect_success(run({"--batch", scene_file.string(), "-f", "1", "-o", "frame.png", "--no-cache"}));
    const Image frame = load_raw_image(folder / "frame.png");
    ViewState view;
    view.size = SizeMode::one_to_one;
    const Rect viewport = layout().viewport;
    const Rect whole = place_frame(view, viewport, 1600, 1200);
    const auto left = int(viewport.x - whole.x), top = int(viewport.y - whole.y);
    ASSERT_GT(left, 0);
    ASSERT_GT(top, 0);
    int wrong = 0;
    for (int y = 150; y < shown.height - 150; ++y)  // words and a frame lie over the edges
        for (int x = 200; x < shown.width - 200; ++x)
            for (int c = 0; c < 3; ++c) {
                const int wanted = int(std::lround(255.0f * frame.at(x + left, y + top)[c]));
                const std::uint32_t rgb =
                    shown.rgb[std::size_t(y) * std::size_t(shown.width) + std::size_t(x)];
                wrong += std::abs(int(rgb >> (16 - 8 * c) & 255) - wanted) > 1;
            }
    EXPECT_EQ(wrong, 0);
}

TEST_F(WindowCompare, WhatACommandDidIsSaid) {
    start_settled();
    const Rect bar = layout().status;
    const auto message = [&] { return screen->pixels({0, int(bar.y), 400, int(bar.height)}); };
    const Pixels before = message();
    choose("Render/Copy batch command");
    EXPECT_TRUE(comes_true([&] { return message() != before; }));
}

// A picture to compare with: over the view where it is placed, blinking, and taken from it.

constexpr std::uint32_t picture_color = IM_COL32(200, 100, 50, 255);
constexpr std::uint32_t no_difference = IM_COL32(128, 128, 128, 255);

/// Of one colour, twice as wide as high, half as high as the frame, named in the scene.
class WindowReference : public WindowTest {
  protected:
    WindowReference() {
        write_plain(folder / "ferner Nebel ä.png", 32, 16, {200, 100, 50});
        write_text(scene_file,
                   text_of(scene_file) + "\n[[reference]]\nfile = \"ferner Nebel ä.png\"\nscale = 0.5\n");
    }
    Rect frame() const {
        const Rect viewport = layout().viewport;
        const OutputParams output = saved().output;
        const double shown =
            std::min(viewport.height / double(output.height), viewport.width / double(output.width));
        return place_frame(ViewState(), viewport, int(std::lround(shown * double(output.width))),
                           int(std::lround(shown * double(output.height))));
    }
    glm::vec2 middle() const { return {frame().x + 0.5f * frame().width, frame().y + 0.5f * frame().height}; }
    int seen() const { return count_of(frame_pixels(), picture_color); }
};

TEST_F(WindowReference, IsPlacedByTheMouseSavedAndUndone) {
    const Pixels before = start_settled();
    EXPECT_EQ(seen(), 0);
    person->press("ctrl+b");
    person->press("p");
    const double area = 0.5 * frame().height * frame().height;
    EXPECT_TRUE(comes_true([&] { return seen() > 0.97 * area; })) << seen();
    person->drag(middle(), {0.25f * frame().height, 0.125f * frame().height});
    expect_title("scene.toml - edited");
    save();
    ASSERT_EQ(saved().references.size(), 1u);
    EXPECT_NEAR(saved().references[0].position.x, 0.25, 0.01);
    EXPECT_NEAR(saved().references[0].position.y, -0.125, 0.01);
    person->press("ctrl+z");
    expect_title("scene.toml - edited");
    person->press("Escape");
    person->press("a");
    expect_settled(before);
    EXPECT_EQ(end(SIGTERM).code, 143);
}

TEST_F(WindowReference, IsNotInThePictureOfASnapshot) {
    start_settled();
    person->press("ctrl+b");
    person->press("a");
    EXPECT_TRUE(comes_true([&] { return seen() > 0; }));
    person->press("b");
    const fs::path picture = folder / "scene.snapshots/0001.png";
    ASSERT_TRUE(comes_true([&] { return fs::exists(picture); }));
    const Image thumbnail = load_raw_image(picture);
    const float* const middle = thumbnail.at(thumbnail.width / 2, thumbnail.height / 2);
    EXPECT_GT(std::fabs(middle[0] - 200.0f / 255.0f) + std::fabs(middle[2] - 50.0f / 255.0f), 0.1f);
}

TEST_F(WindowReference, BlinksAndStops) {
    const Pixels before = start_settled();
    person->press("ctrl+b");
    person->press("x");
    for (int change = 0; change < 2; ++change) {
        EXPECT_TRUE(comes_true([&] { return seen() > 0; }));
        EXPECT_TRUE(comes_true([&] { return seen() == 0; }));
    }
    person->press("x");
    expect_settled(before);
}

TEST_F(WindowReference, OneThatCannotBeReadIsSaid) {
    fs::remove(folder / "ferner Nebel ä.png");
    const Pixels before = start_settled();
    person->press("ctrl+b");
    person->press("a");
    const Rect bar = layout().status;
    EXPECT_TRUE(comes_true([&] {
        return count_of(screen->pixels({0, int(bar.y), 600, int(bar.height)}), color::error) > 0;
    })) << "the message is red";
    EXPECT_EQ(frame_pixels(), before);
}

/// The frame itself, as a picture that lies elsewhere.
TEST_F(WindowReference, IsAlignedToTheView) {
    expect_success(run({"--batch", scene_file.string(), "-f", "1", "-o", "frame.png", "--no-cache"}));
    std::string text = text_of(scene_file);
    text.replace(text.find("ferner Nebel"), text.size(),
                 "frame.png\"\nposition = [0.1, -0.05]\nscale = 0.8\n");
    write_text(scene_file, text);
    start_settled();
    same_widgets().status.reference = ReferenceStatus{0, 16.0 / 9.0, ""};
    same_widgets().frame(2);
    choose("View/Align reference to this view");
    expect_title("scene.toml - edited");
    save();
    const ReferenceParams found = saved().references.at(0);
    EXPECT_NEAR(found.position.x, 0.0, 1.0 / frame().height);
    EXPECT_NEAR(found.position.y, 0.0, 1.0 / frame().height);
    EXPECT_NEAR(found.scale, 1.0, 0.005);
    person->press("ctrl+z");
    expect_title("scene.toml - edited");
}

/// Pixels equal to B are grey in the difference, whatever is stored as B; changes lie about that grey.
TEST_F(WindowReference, TheDifferenceFromBIsNeverBlack) {
    start_settled();
    person->press("b");
    choose("View/Difference");
    const double pixels = double(frame().width) * double(frame().height);
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), no_difference) > 0.8 * pixels; }));
    person->press("b");
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), no_difference) > 0.8 * pixels; }));
    person->drag(value_box(power), {60.0f, 0.0f});
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), no_difference) < 0.8 * pixels; }));
}

}  // namespace
}  // namespace astrosplat::test
