// Scenes edited in the window: begun, dragged, typed, animated and saved; and files that change, are dropped
// and chosen in the dialog.
#include "core/atomic_file.h"
#include "edit/edits.h"
#include "edit/preferences.h"
#include "gui/widgets.h"
#include "sets/kept.h"
#include "source/write_image.h"
#include "support/fits_text.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

// Scenes begun in the window: empty, with a shape, with a mesh that has no picture.

class WindowNew : public WindowTest {
  protected:
    static int lit(const Pixels& pixels) {
        int count = 0;
        for (const std::uint32_t rgb : pixels.rgb) count += (rgb & 0xff) > 40 && (rgb >> 16 & 0xff) > 40;
        return count;
    }
};

TEST_F(WindowNew, AnEmptySceneTakesAShape) {
    start_settled();
    choose("File/New/Empty scene");
    expect_title("Untitled");
    EXPECT_TRUE(comes_true([&] { return lit(frame_pixels()) < 8000; })) << "only words and the gate are left";
    choose("Layer/Add shape/Sphere");
    expect_title("Untitled - edited");
    EXPECT_TRUE(comes_true([&] { return settled() && lit(frame_pixels()) > 20000; }))
        << program->err_so_far();
    EXPECT_EQ(end(SIGTERM).code, 143);
}

TEST_F(WindowNew, AMeshWithoutAPictureIsNeutralGrey) {
    write_text(folder / "netz.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n");
    fs::remove(folder / "rings.png");
    start({(folder / "netz.obj").string(), "--no-cache"});
    EXPECT_TRUE(comes_true([&] { return settled() && lit(frame_pixels()) > 20000; }))
        << program->err_so_far();
    ViewState offers;
    offers.grey_layer = "netz";
    const Rect notice = make_layout(offers, width, height, 1.0f).notice;
    EXPECT_GT(lit(screen->pixels({int(notice.x), int(notice.y), 500, int(notice.height)})), 100)
        << "it is said";
}

// A value is dragged, typed, undone and saved.

class WindowLook : public WindowTest {};

TEST_F(WindowLook, AValueIsDraggedSavedAndUndone) {
    const Pixels before = start_settled();
    person->drag(value_box(power), {60.0f, 0.0f});
    expect_title("scene.toml - edited");
    const Pixels after = settled_frame(before);
    save();
    EXPECT_GT(saved().layers[0].look.alpha.power, 1.0f);
    const std::string text = text_of(scene_file);
    for (const char* comment : {"# by hand, keep this", "# px", "# the only one"})
        EXPECT_HAS(text, comment) << comment;

    person->press("ctrl+z");
    expect_title("scene.toml - edited");
    expect_settled(before);
    person->press("ctrl+shift+z");
    expect_title("scene.toml");
    expect_settled(after);
}

TEST_F(WindowLook, AValueIsTypedAfterADoubleClick) {
    const Pixels before = start_settled();
    person->double_click(value_box(power));
    person->type("2.25");
    person->press("Return");
    expect_title("scene.toml - edited");
    settled_frame(before);
    save();
    EXPECT_EQ(saved().layers[0].look.alpha.power, 2.25f);
}

// A value gets keyframes at two frames through panel and timeline; what is saved plays the same again.

class WindowTime : public WindowTest {
  protected:
    /// Takes the playhead to the last frame by mouse.
    void scrub_to_the_end() {
        TestWindow& widgets = same_widgets();
        const float y = widgets.at("ruler").y;
        const float first = widgets.at("keyframe camera.position 1").x,
                    last = widgets.at("keyframe camera.position 24").x;
        person->drag({first, y}, {last - first, 0.0f});
    }
};

TEST_F(WindowTime, AValueIsKeyedAtTwoFramesAndPlaysAgain) {
    const Pixels first = start_settled();
    const Pixels timeline = pixels_of(&Layout::timeline);
    person->click(diamond(power));
    expect_title("scene.toml - edited");
    EXPECT_TRUE(comes_true([&] { return pixels_of(&Layout::timeline) != timeline; }))
        << "no row of keyframes";
    expect_settled(first);

    scrub_to_the_end();
    const Pixels before = settled_frame(first);
    person->double_click(value_box(power));
    person->type("3");
    person->press("Return");
    const Pixels last = settled_frame(before);
    save();

    const Scene scene = saved();
    const Track* track = find_track(scene, power);
    ASSERT_NE(track, nullptr);
    ASSERT_EQ(track->keyframes.size(), 2u);
    EXPECT_EQ(track->keyframes[0].frame, 1.0);
    EXPECT_EQ(track->keyframes[0].value, std::vector<double>{1.0});
    EXPECT_EQ(track->keyframes[1].frame, 24.0);
    EXPECT_EQ(track->keyframes[1].value, std::vector<double>{3.0});
    EXPECT_EQ(find_track(scene, "camera.position")->keyframes.size(), 2u);

    person->press("ctrl+q");
    EXPECT_EQ(end().code, 0);
    start();
    expect_settled(first);
    scrub_to_the_end();
    expect_settled(last);
}

// A level is dragged: the picture follows at once, without a new set, which comes once the hand rests.

const std::string black = "layer.disc.source.black";

class WindowLevels : public WindowTest {
  protected:
    WindowLevels() {
        write_text(folder / "data.fits", fits_file(64, 64, "", [](int x, int y) {
                       return 1.0 + 0.04 * x + (x / 8 + y / 8) % 2 * 1.0;
                   }));
        replace_in_scene("rings.png", "data.fits");
        replace_in_scene("count = ", "stretch = \"linear\"\nblack = 2.5\nwhite = 5.0\ncount = ");
    }

    void SetUp() override {
        WindowTest::SetUp();
        if (IsSkipped()) return;
        same_widgets().view.tab = PanelTab::source;
        auto histograms = std::make_shared<LayerHistograms>();
        histograms->values.share.assign(LayerHistograms::bins, 0.5f);
        same_widgets().status.layers[0].histograms = std::move(histograms);
        same_widgets().frame(3);
    }
    /// The tab that is chosen, by the line below its name.
    glm::vec2 chosen_tab() {
        constexpr int least_px = 20;
        const Picture8 picture = same_widgets().picture();
        const auto is_line = [&](int x, int y) {
            const Rgba8& p = picture.at(x, y);
            return IM_COL32(p.r, p.g, p.b, 255) == color::accent;
        };
        for (int y = 40; y < height; ++y)
            for (int x = width * 2 / 3; x + least_px < width; ++x) {
                int length = 0;
                while (length < least_px && is_line(x + length, y)) ++length;
                if (length == least_px) return {x + least_px / 2, y - 12};
            }
        ADD_FAILURE() << "no tab is chosen";
        return {};
    }
    fs::path cache() const { return folder / "home/cache/astrosplat"; }
    std::vector<fs::path> geometries() const {
        std::vector<fs::path> files;
        for (const auto& file : fs::directory_iterator(cache()))
            if (file.path().extension() == ".splats") files.push_back(file.path());
        return files;
    }
    /// Mean of all channels.
    static double brightness(const Pixels& pixels) {
        double sum = 0.0;
        for (const std::uint32_t rgb : pixels.rgb) sum += (rgb >> 16 & 255) + (rgb >> 8 & 255) + (rgb & 255);
        return sum / (3.0 * double(pixels.rgb.size()));
    }
};

// Light that was too dark to be there comes back, too.
TEST_F(WindowLevels, ADraggedLevelIsSeenWithoutANewSet) {
    start({scene_file.string()});
    const Pixels before = settled_frame();
    person->click(chosen_tab());
    ASSERT_EQ(geometries().size(), 1u);
    {
        // As if another process made it, no set can be made while this is held.
        FileLock held(geometries()[0].replace_extension(".lock"));
        ASSERT_EQ(held.try_lock(), FileLock::State::held);
        person->drag(value_box(black), {-300.0f, 0.0f});
        expect_title("scene.toml - edited");
        EXPECT_TRUE(comes_true([&] { return brightness(frame_pixels()) > 1.2 * brightness(before); }));
        EXPECT_FALSE(settled()) << "what is followed is no final picture";
        person->press("ctrl+z");
        expect_settled(before);
        person->press("ctrl+shift+z");
        EXPECT_TRUE(comes_true([&] { return brightness(frame_pixels()) > 1.2 * brightness(before); }));
    }
    const Pixels after = settled_frame(before);
    EXPECT_GT(brightness(after), 1.2 * brightness(before));
    EXPECT_EQ(geometries().size(), 1u);
    save();
    EXPECT_LT(saved().layers[0].source.texture.black, 2.0);
    end(SIGTERM);
    start({scene_file.string(), "--no-cache"});  // what --batch and --screenshot draw of the file
    expect_settled(after);
}

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
    person->press("ctrl+o");
    person->type("pictures");
    person->press("Return");
    EXPECT_TRUE(comes_true([&] { return seen(201, 40) && seen(40, 203); }));
    EXPECT_FALSE(seen(105, 106)) << "below all others";
    person->scroll({width * 0.5f, height * 0.5f}, 400);
    EXPECT_TRUE(comes_true([&] { return seen(105, 106); }));
    EXPECT_FALSE(seen(201, 40));
    EXPECT_EQ(end(SIGTERM).err.find("broken"), std::string::npos) << "it was not opened";
}

using WindowStart = WindowTest;

TEST_F(WindowStart, AnotherKindIsTakenAndUndone) {
    start({(folder / "rings.png").string(), "--no-cache"});
    settled_frame();
    EXPECT_EQ(title(), "Untitled - astrosplat");
    person->press("Tab");  // to the card, whose last button it is
    person->press("shift+Tab");
    person->press("space");
    const auto keyframes = [&] { return count_of(pixels_of(&Layout::timeline), color::attention); };
    EXPECT_TRUE(comes_true([&] { return keyframes() > 0; }));
    EXPECT_EQ(title(), "Untitled - astrosplat") << "as it began again";
    person->press("ctrl+z");
    EXPECT_TRUE(comes_true([&] { return keyframes() == 0; }));
    person->press("ctrl+shift+z");
    EXPECT_TRUE(comes_true([&] { return keyframes() > 0; }));
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
