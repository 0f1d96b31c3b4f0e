// Files that change, that are dropped, and that are chosen in the dialog.

#include "edit/preferences.h"
#include "gui/widgets.h"
#include "source/write_image.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

// Files that a scene is made of are changed by other programs while it is open.

class WindowFiles : public WindowTest {
  protected:
    void write_plain(const std::string& name, unsigned char red, unsigned char blue) {
        test::write_plain(folder / name, 64, 64, {red, 90, blue});
    }
    /// Something in the window is in the colour of errors.
    bool failed() const { return count_of(screen->pixels({0, 0, width, height}), color::error) > 10; }
    void add(const std::string& before, const std::string& lines) {
        replace_in_scene(before, lines + before);
    }
};

TEST_F(WindowFiles, ATextureIsReadAgain) {
    const Pixels before = start_settled();
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
    const Pixels before = start_settled();
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

// Files dropped on the window by another program.

class WindowDrop : public WindowTest {
  protected:
    glm::vec2 middle() { return same_widgets().at("frame in view"); }
};

TEST_F(WindowDrop, APictureBecomesALayerAndASceneIsOpened) {
    const Pixels before = start_settled();
    write_rings(folder / "übrig 2.png");
    ASSERT_TRUE(screen->drop({folder / "übrig 2.png"}, middle()));
    expect_title("scene.toml - edited");
    settled_frame(before);
    save();
    const Scene scene = saved();
    ASSERT_EQ(scene.layers.size(), 2u);
    const std::vector<MeshInput>& meshes = scene.layers[1].source.meshes;
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(meshes[0].mesh, "plane");
    EXPECT_EQ(meshes[0].texture, std::vector<fs::path>{folder / "übrig 2.png"});

    fs::copy_file(scene_file, folder / "other.toml");
    ASSERT_TRUE(screen->drop({folder / "other.toml"}, middle()));
    expect_title("other.toml");
}

TEST_F(WindowDrop, ACameraDrivesTheScenes) {
    const Pixels before = start_settled();
    write_text(folder / "weg ü.chan", "1 0 3 9 -15 10 0 30\n");
    ASSERT_TRUE(screen->drop({folder / "weg ü.chan"}, middle()));
    expect_title("scene.toml - edited");
    settled_frame(before);
    save();
    EXPECT_EQ(saved().camera.file, folder / "weg ü.chan");
    EXPECT_EQ(saved().layers.size(), 1u);
}

TEST_F(WindowDrop, ALookIsGivenToTheLayer) {
    const Pixels before = start_settled();
    write_text(folder / "look.toml", "[look]\nalpha = { power = 3.0 }\n");
    ASSERT_TRUE(screen->drop({folder / "look.toml"}, middle()));
    expect_title("scene.toml - edited");
    settled_frame(before);
    save();
    EXPECT_EQ(saved().layers[0].look.alpha.power, 3.0f);
}

TEST_F(WindowDrop, OnTheDemoAPictureBecomesAGalaxy) {
    start({"--no-cache"});
    expect_title("Untitled");
    ASSERT_TRUE(screen->drop({folder / "rings.png"}, middle()));
    settled_frame();
    person->press("ctrl+s");
    person->press("ctrl+a");
    person->type("galaxy.toml");
    person->press("Return");
    expect_title("galaxy.toml");
    const Scene scene = load_scene(folder / "galaxy.toml");
    ASSERT_EQ(scene.layers.size(), 1u);
    EXPECT_EQ(scene.layers[0].source.meshes[0].mesh, "plane");
    EXPECT_EQ(scene.layers[0].source.meshes[0].texture, std::vector<fs::path>{folder / "rings.png"});
}

// The window's own file dialog by real keys and clicks: names typed faster than anybody types, pictures seen
// before they are chosen, in folders as large as a film's.

class WindowFileDialog : public WindowTest {
  protected:
    void write_plain(const std::string& name, int side, unsigned char red, unsigned char green) const {
        test::write_plain(folder / name, side, side, {red, green, 30});
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
    start_settled();
    choose("File/Import as a layer...");
    person->type("pictures");
    person->press("Return");
    EXPECT_TRUE(comes_true([&] { return seen(201, 40) && seen(40, 203); }));
    EXPECT_FALSE(seen(105, 106)) << "below all others";
    person->scroll({width * 0.5f, height * 0.5f}, 400);
    EXPECT_TRUE(comes_true([&] { return seen(105, 106); }));
    EXPECT_FALSE(seen(201, 40));
    EXPECT_EQ(end(SIGTERM).err.find("broken"), std::string::npos) << "it was not opened";
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
