// The window's own file dialog by real keys and clicks: names typed faster than anybody types, pictures seen
// before they are chosen, in folders as large as a film's.
#include "edit/preferences.h"
#include "source/write_image.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowFileDialog : public WindowTest {
  protected:
    void write_plain(const std::string& name, int side, unsigned char red, unsigned char green) const {
        std::vector<unsigned char> rgba;
        for (int i = 0; i < side * side; ++i) rgba.insert(rgba.end(), {red, green, 30, 255});
        write_image(folder / name, side, side, rgba);
    }
    Pixels window() const { return screen->pixels({0, 0, width, height}); }
    /// A thumbnail of 48 px a side, without its rim.
    static constexpr int most_of_one = 40 * 40;
    bool seen(unsigned char red, unsigned char green) const {
        return count_of(window(), IM_COL32(red, green, 30, 255)) > most_of_one;
    }
};

TEST_F(WindowFileDialog, ALongNameTypedFastKeepsEveryCharacter) {
    fs::create_directories(folder / "many");
    for (int i = 0; i < 4000; ++i)
        write_text(folder / ("many/frame" + std::to_string(10000 + i) + ".toml"), "");
    const std::string name = "the quick brown fox jumps over the lazy dog 0123456789.toml";
    fs::copy_file(scene_file, folder / "many" / name);
    fs::copy_file(folder / "rings.png", folder / "many/rings.png");
    start();
    person->press("ctrl+o");
    person->type("many", 30);
    person->enter_and_type(name, 8);
    person->press("Return");
    expect_title(name);
}

TEST_F(WindowFileDialog, PicturesAreSeenBeforeTheyAreChosen) {
    fs::create_directories(folder / "pictures");
    write_plain("pictures/b red.png", 500, 201, 40);
    write_plain("pictures/c green.tif", 300, 40, 203);
    write_text(folder / "pictures/a broken.jpg", "no picture");
    for (int i = 0; i < 300; ++i)
        fs::copy_file(folder / "rings.png", folder / ("pictures/d" + std::to_string(100 + i) + ".png"));
    write_plain("pictures/z last.png", 200, 105, 106);
    start();
    settled_frame();
    choose("File/Import as a layer...");
    person->type("pictures");
    person->press("Return");
    EXPECT_TRUE(comes_true([&] { return seen(201, 40) && seen(40, 203); }));
    EXPECT_FALSE(seen(105, 106)) << "below all others";
    person->scroll({width * 0.5f, height * 0.5f}, 400);
    EXPECT_TRUE(comes_true([&] { return seen(105, 106); }));
    EXPECT_FALSE(seen(201, 40));
    EXPECT_EQ(end(SIGTERM).err.find("broken"), std::string::npos) << "nobody opened it";
}

TEST_F(WindowFileDialog, WhateverWasOpenedIsRecent) {
    start({(folder / "rings.png").string(), "--no-cache"});
    person->press("ctrl+o");
    person->type(scene_file.filename().string(), 30);
    person->press("Return");
    expect_title("scene.toml");
    person->press("ctrl+q");
    end();
    const Preferences kept = load_preferences(folder / "home/config/astrosplat/viewer.json");
    EXPECT_EQ(kept.recent, (std::vector<fs::path>{scene_file, folder / "rings.png"}));
}

}  // namespace
}  // namespace astrosplat::test
