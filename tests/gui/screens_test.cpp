// The main states of the window, drawn: every one must put its controls inside the window and their words on
// screen; with $ASTROSPLAT_GUI_PICTURES they are kept to be looked at.
#include <gtest/gtest.h>

#include <tuple>

#include "gui/key_codes.h"
#include "gui/test_window.h"

namespace astrosplat {
namespace {

struct Size {
    int width, height;
    const char* name;
    float scale;
    friend void PrintTo(const Size& given, std::ostream* out) { *out << given.name; }
};
constexpr Size sizes[] = {
    {1600, 900, "large", 1.0f}, {1100, 700, "small", 1.0f}, {2200, 1400, "double", 2.0f}};

class Screens : public testing::TestWithParam<Size> {
  protected:
    Screens() : window(example_document(), GetParam().width, GetParam().height, GetParam().scale) {}

    // Every control that was drawn can be reached by the mouse.
    void keep(const std::string& name) {
        window.frame(2);
        window.keep_screen(std::string(GetParam().name) + "_" + name);
        for (const DrawnItem& item : window.gui.drawn_items()) {
            if (item.name.rfind("track ", 0) == 0 || item.name.rfind("keyframe ", 0) == 0)
                continue;  // may be scrolled away
            EXPECT_GE(item.middle.x, 0) << name << ": " << item.name;
            EXPECT_GE(item.middle.y, 0) << name << ": " << item.name;
            EXPECT_LE(item.middle.x, GetParam().width) << name << ": " << item.name;
            EXPECT_LE(item.middle.y, GetParam().height) << name << ": " << item.name;
        }
    }
    TestWindow window;
};

TEST_P(Screens, Main) {
    window.view.frame = 86;
    keep("main");
}
TEST_P(Screens, Menus) {
    for (const char* menu : {"File", "Edit", "View", "Layer", "Camera", "Render", "Help"}) {
        window.click(menu);
        keep(std::string("menu_") + menu);
        window.tap(key_code::escape);
    }
}
TEST_P(Screens, Graph) {
    window.view.frame = 60;
    window.click("graph");
    window.click("track camera.position");
    keep("graph");
}
TEST_P(Screens, SnapshotsAndWipe) {
    window.view.snapshots_open = true;
    window.view.compare = CompareMode::wipe;
    void* picture = window.status.viewport_texture;
    window.status.snapshots = {{"Warm dust", picture, 1.83f, 12400000, 1.8},
                               {"Before the noise", picture, 1.83f, 12400000, 0}};
    window.status.b_snapshot = 0;
    window.status.b_name = "Warm dust";
    keep("wipe");
}
TEST_P(Screens, Sheets) {
    window.tap(key_code::f1);
    keep("shortcuts");
    window.tap(key_code::escape);
    window.view.log_open = true;
    window.status.log.push_back(
        {"whirlpool.toml:12: expected one of over, add or screen, found the text 'plus'", true});
    keep("log");
}
TEST_P(Screens, Questions) {
    window.document.edit("Opacity", [](Scene& scene) { scene.layers[0].render.opacity = 0.5; });
    window.choose("File/Quit");
    keep("unsaved");
    window.tap(key_code::escape);
    window.status.recoveries = {
        {"/state/whirlpool-812-3f.toml", "whirlpool.toml", "2026-04-12 18:03:10 UTC"}};
    keep("recovery");
}
TEST_P(Screens, OpenAFile) {
    window.status.recent = {"/usr/share/doc/a.toml",
                            std::filesystem::path(ASTROSPLAT_SOURCE_DIR) / "assets/scenes/nebula.toml"};
    window.choose("File/Open...");
    window.type(ASTROSPLAT_SOURCE_DIR "/assets");
    window.click("file/Open");
    keep("open");
}
TEST_P(Screens, Failed) {
    window.status.view_frame.state = ViewFrameState::failed;
    window.status.view_frame.error =
        "the picture 'stars.png' of layer stars cannot be read: no such file or directory";
    window.status.message = {"/scenes/whirlpool.toml:14: expected a file that can be read, found none", true};
    window.status.changed_on_disk = true;
    window.status.jobs.push_back(running_job_of("frame 12 (12/240)", 0.05f));
    keep("failed");
}
TEST_P(Screens, FirstStart) {
    window.view.hint_open = true;
    window.status.layers[1].loading = true;
    window.status.layers[1].progress = 0.37f;
    window.status.layers[1].found = 3100000;
    keep("first_start");
}
TEST_P(Screens, LittleShown) {
    window.status.view_frame.state = ViewFrameState::preview;
    window.view.view = ViewKind::free;
    window.view.inspect_exposure = 2.5f;
    window.status.overlay_lines = {{{100, 300}, {300, 250}, {500, 330}}};
    keep("little");
}
TEST_P(Screens, WithoutPanels) {
    window.tap(key_code::f11);
    window.status.view_frame.state = ViewFrameState::final;
    window.status.view_frame.seconds = 1.8;
    window.view.safe_areas = true;
    keep("no_panels");
}

INSTANTIATE_TEST_SUITE_P(Sizes, Screens, testing::ValuesIn(sizes),
                         [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace astrosplat
