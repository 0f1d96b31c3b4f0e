// Files that a scene is made of are changed by other programs while it is open.
#include <thread>

#include "gui/theme.h"
#include "source/write_image.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowFiles : public WindowTest {
  protected:
    void write_plain(const std::string& name, unsigned char red, unsigned char blue) {
        constexpr int size = 64;
        std::vector<unsigned char> rgba;
        for (int i = 0; i < size * size; ++i) rgba.insert(rgba.end(), {red, 90, blue, 255});
        write_image(folder / name, size, size, rgba);
    }
    /// Something in the window is in the colour of errors.
    bool failed() const { return count_of(screen->pixels({0, 0, width, height}), color::error) > 10; }
    void add(const std::string& before, const std::string& lines) {
        std::string text = text_of(scene_file);
        text.insert(text.find(before), lines);
        write_text(scene_file, text);
    }
};

TEST_F(WindowFiles, ATextureIsReadAgain) {
    start();
    const Pixels before = settled_frame();
    write_plain("rings.png", 250, 10);
    const Pixels after = settled_frame(before);
    write_plain("rings.png", 10, 250);
    settled_frame(after);
    write_rings(folder / "rings.png");
    expect_settled(before);
    EXPECT_EQ(title(), "scene.toml - astrosplat") << "nothing of the scene is edited";
}

TEST_F(WindowFiles, SkyAndThicknessMapAreReadAgain) {
    write_plain("sky.png", 60, 10);
    write_plain("thick.png", 255, 255);
    add("[[layer]]", "[environment]\nimage = \"sky.png\"\n");
    add("[animation]",
        "[layer.look.thickness]\nmap = \"thick.png\"\nkeys = [ { color = [1, 0.35, 1], scale = 1.0 }, "
        "{ color = [0, 0.35, 0], scale = 0.2 } ]\n\n");
    start();
    const Pixels before = settled_frame();
    write_plain("thick.png", 0, 0);
    const Pixels thin = settled_frame(before);
    write_plain("sky.png", 10, 60);
    settled_frame(thin);
    write_plain("sky.png", 60, 10);
    expect_settled(thin);
    write_plain("thick.png", 255, 255);
    expect_settled(before);
}

TEST_F(WindowFiles, WhatWasMissingIsShownWhenItComes) {
    fs::rename(folder / "rings.png", folder / "away.png");
    start();
    EXPECT_TRUE(comes_true([&] { return failed(); }));
    fs::rename(folder / "away.png", folder / "rings.png");
    settled_frame();
}

/// A shortcut that fails says so in the window, not only at the terminal it was started from.
TEST_F(WindowFiles, WhatCannotBeKeyedIsSaidInTheMessageBar) {
    fs::remove(folder / "rings.png");  // so that there is nothing to frame
    std::string text = text_of(scene_file);
    text.erase(text.find("position"), text.find("target") - text.find("position"));
    text.erase(text.find("[animation]"));
    write_text(scene_file, text);
    start();
    const auto red = [&] { return count_of(pixels_of(&Layout::status), color::error); };
    EXPECT_TRUE(comes_true([&] { return red() > 10; })) << "why the layer failed";
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto before = red();
    person->press("k");
    EXPECT_TRUE(comes_true([&] { return red() > 10 && red() != before; })) << "then why there is no keyframe";
}

}  // namespace
}  // namespace astrosplat::test
