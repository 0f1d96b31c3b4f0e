// A click in the picture selects the layer that is seen there.
#include "source/write_image.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

/// Two flat squares side by side, and a dimmer one behind the right one.
class WindowSelect : public WindowTest {
  protected:
    WindowSelect() {
        std::vector<unsigned char> rgba;
        for (int i = 0; i < 16 * 16; ++i) rgba.insert(rgba.end(), {200, 200, 200, 255});
        write_image(folder / "grey.png", 16, 16, rgba);
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
        const Rect panel = make_layout(ViewState(), width, height, 1.0f).panel;
        return {panel.x + 100.0f, panel.y + 32.0f + 28.0f * (static_cast<float>(index) + 0.5f)};
    }
    Area list_area() const {
        const Rect panel = make_layout(ViewState(), width, height, 1.0f).panel;
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
        const Rect area = make_layout(ViewState(), width, height, 1.0f).viewport;
        return {area.x + 0.5f * area.width + right * area.height, area.y + 0.5f * area.height};
    }
};

TEST_F(WindowSelect, AClickSelectsAndAnotherTakesTheOneBehind) {
    start();
    settled_frame();
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

}  // namespace
}  // namespace astrosplat::test
