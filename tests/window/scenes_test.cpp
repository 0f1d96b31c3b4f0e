// Scenes edited in the window: begun, dragged, typed, animated and saved.

#include "core/atomic_file.h"
#include "edit/edits.h"
#include "gui/widgets.h"
#include "sets/kept.h"
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
        EXPECT_NE(text.find(comment), std::string::npos) << comment;

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

}  // namespace
}  // namespace astrosplat::test
