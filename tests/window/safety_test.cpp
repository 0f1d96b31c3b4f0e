// Unsaved changes survive a crash, and a scene edited by hand meanwhile is offered.
#include "gui/theme.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowSafety : public WindowTest {
  protected:
    WindowSafety() { environment = {"ASTROSPLAT_AUTOSAVE_SECONDS=1"}; }

    std::vector<fs::path> autosaves() const {
        std::vector<fs::path> files;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder / "home/state/astrosplat/autosave", ignored))
            if (entry.path().extension() == ".toml" && entry.path().filename().string()[0] != '.')
                files.push_back(entry.path());
        return files;
    }
    void edit() {
        start();
        settled_frame();
        person->drag(value_box(power), {60.0f, 0.0f});
        expect_title("scene.toml - edited");
    }
    void offer_recovery() {
        std::vector<RecoveryOffer>& offers = same_widgets().status.recoveries;
        for (const fs::path& file : autosaves()) offers.push_back({file, "scene.toml", "now"});
        ASSERT_EQ(offers.size(), 1u);
        same_widgets().frame(3);
    }
};

TEST_F(WindowSafety, AKilledSessionIsRecovered) {
    edit();
    ASSERT_TRUE(comes_true([&] { return !autosaves().empty(); }));
    EXPECT_EQ(end(SIGKILL).code, -SIGKILL);
    EXPECT_EQ(saved().layers[0].look.alpha.power, 1.0f);

    start();
    expect_title("scene.toml");
    offer_recovery();
    click_when_shown("recovery/Recover");
    expect_title("scene.toml - edited");
    person->press("ctrl+s");
    expect_title("scene.toml");
    EXPECT_GT(saved().layers[0].look.alpha.power, 1.0f);
    EXPECT_NE(text_of(scene_file).find("# by hand, keep this"), std::string::npos);
    EXPECT_TRUE(comes_true([&] { return autosaves().empty(); }));
}

TEST_F(WindowSafety, ATerminatedSessionSavesAtOnceAndMayBeDiscarded) {
    environment.clear();
    edit();
    EXPECT_TRUE(autosaves().empty());
    EXPECT_EQ(end(SIGTERM).code, 128 + SIGTERM);
    start();
    offer_recovery();
    click_when_shown("recovery/Discard");
    EXPECT_TRUE(comes_true([&] { return autosaves().empty(); }));
    EXPECT_EQ(title(), "scene.toml - astrosplat");
    EXPECT_EQ(saved().layers[0].look.alpha.power, 1.0f);
}

class WindowDisk : public WindowSafety {
  protected:
    void replace(const std::string& what, const std::string& by) {
        std::string text = text_of(scene_file);
        text.replace(text.find(what), what.size(), by);
        write_text(scene_file, text);
        same_widgets().status.changed_on_disk = true;
        same_widgets().frame(3);
    }
    /// In the colour of errors: the badge where it cannot render.
    bool picture_failed() const {
        const Layout layout = make_layout(ViewState(), width, height, 1.0f);
        const Rect& port = layout.viewport;
        return count_of(screen->pixels({0, static_cast<int>(port.y + port.height) - 50, 100, 50}),
                        color::error) > 10;
    }
    int complaints() const { return count_of(pixels_of(&Layout::status), color::error); }
};

TEST_F(WindowDisk, ASceneEditedByHandIsReadAgain) {
    start();
    const Pixels before = settled_frame();
    replace("count = 60000", "count = 60000\n[layer.look]\nalpha = { power = 2.5 }");
    click_when_shown("notice/Reload");
    settled_frame(before);
    EXPECT_EQ(title(), "scene.toml - astrosplat");

    replace("power = 2.5", "powr = 2.5");
    click_when_shown("notice/Reload");
    EXPECT_TRUE(comes_true([&] { return complaints() > 0; })) << "the wrong key is not complained of";
    EXPECT_TRUE(running());

    replace("powr = 2.5", "power = 1.0");
    click_when_shown("notice/Reload");
    expect_settled(before);
}

TEST_F(WindowDisk, AnEnvironmentThatCannotBeReadEndsNothing) {
    write_text(folder / "sky.png", "no picture");
    start();
    const Pixels before = settled_frame();
    replace("[[layer]]", "[environment]\nimage = \"sky.png\"\n[[layer]]");
    click_when_shown("notice/Reload");
    EXPECT_TRUE(comes_true([&] { return picture_failed() || !running(); }));
    ASSERT_TRUE(running()) << program->err_so_far();
    person->press("ctrl+z");
    expect_settled(before);
}

}  // namespace
}  // namespace astrosplat::test
