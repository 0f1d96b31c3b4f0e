// The camera's path by hand: a keyframe is dragged in the view, and frames that are rendered are played.
#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "edit/keyframes.h"
#include "gui/theme.h"
#include "source/write_image.h"
#include "support/color_config.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowPath : public WindowTest {
  protected:
    /// Keyframes that a view from above shows, at frames 1 and 24.
    void write_low_path() {
        std::ostringstream text;
        text << std::ifstream(scene_file).rdbuf();
        std::string scene = text.str();
        scene.replace(scene.find("[[1, ["), std::string::npos,
                      "[[1, [0.0, 6.0, 2.0]], [24, [3.0, 5.0, 2.0]]] }\n");
        write_text(scene_file, scene);
    }
    /// The middle of a point of the path at another frame than the one that is seen.
    std::optional<glm::vec2> point_on_path() const {
        const Rect area = make_layout(ViewState(), width, height, 1.0f).viewport;
        const Pixels seen = frame_pixels();
        const auto is_key = [&](int x, int y) {
            return seen.rgb[static_cast<std::size_t>(y * seen.width + x)] == 0xD9A441;
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
        std::vector<unsigned char> rgba;
        for (int i = 0; i < 320 * 180; ++i) rgba.insert(rgba.end(), {level, level, level, 255});
        fs::create_directories(folder / "frames");
        write_image(folder / fmt::format("frames/shot.{:04}.png", frame), 320, 180, rgba);
    }
    /// Frame 1 lies there as light of 0.2, and one stop of exposure.
    void show_rendered_light(const std::string& view) {
        std::ostringstream text;
        text << std::ifstream(scene_file).rdbuf();
        std::string scene = text.str();
        scene.replace(scene.find("shot.####.png"), 13, "shot.####.exr");
        scene.insert(scene.find("frames = "), view + "\nexposure = 1.0\n");
        write_text(scene_file, scene);
        fs::create_directories(folder / "frames");
        write_linear_image(folder / "frames/shot.0001.exr", make_image(320, 180, 4, 0.2f), "",
                           Existing::replace);
        start();
        settled_frame();
        person->click(same_widgets().at("playing/Rendered"));
    }
    bool sees(unsigned char level) const {
        return count_of(frame_pixels(), IM_COL32(level, level, level, 255)) > 10'000;
    }
};

TEST_F(WindowPath, AKeyframeIsDraggedInTheView) {
    write_low_path();
    start();
    const Pixels camera = settled_frame();
    person->press("7");
    settled_frame(camera);
    const std::optional<glm::vec2> point = point_on_path();
    ASSERT_TRUE(point);
    person->drag(*point, {80.0f, 0.0f});
    expect_title("scene.toml - edited");
    person->press("ctrl+s");
    expect_title("scene.toml");
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
    start();
    settled_frame();
    person->click(same_widgets().at("playing/Rendered"));
    EXPECT_TRUE(comes_true([&] { return sees(100); }));
    person->press("ctrl+Right");
    EXPECT_TRUE(comes_true([&] { return sees(200); }));
    person->press("Left");
    EXPECT_TRUE(comes_true([&] { return !sees(200) && !sees(100); })) << "frame 23 is not rendered";
    write_frame(23, 150);
    EXPECT_TRUE(comes_true([&] { return sees(150); })) << "and now it is";
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

}  // namespace
}  // namespace astrosplat::test
