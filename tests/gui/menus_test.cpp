// Where things lie, menus and settings.
#include <tuple>

#include "core/color.h"
#include "edit/view_camera.h"
#include "gui/parts.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "scene/describe.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Menus: every item can be reached and becomes its command, or a question for a file.

using Kind = Command::Kind;

class MenusTest : public ExampleWindow {};

TEST_F(MenusTest, EveryItemCanBeReached) {
    for (const Action& action : actions()) {
        const std::string path = std::string(action.menu) + "/" + action.label;
        if (path.front() == '/') continue;  // keys only
        const std::string menu = path.substr(0, path.find('/'));
        window.click(menu);
        if (std::count(path.begin(), path.end(), '/') == 2) {
            window.move(window.at(action.menu));
            window.frame(30);
        }
        EXPECT_TRUE(window.has(path)) << path;
        window.tap(key_code::escape);
        window.tap(key_code::escape);
    }
}

TEST(MenusOfAnother, ItemsBecomeCommands) {
    const std::vector<std::pair<std::string, Kind>> expected{
        {"File/Open the demo", Kind::open_demo},
        {"Edit/Store as B", Kind::store_b},
        {"Edit/Take snapshot", Kind::take_snapshot},
        {"View/Frame layer", Kind::frame_layer},
        {"View/Frame all", Kind::frame_all},
        {"Render/Copy batch command", Kind::copy_batch_command},
        {"File/Quit", Kind::quit}};
    TestWindow window(example_document());
    for (const auto& [path, kind] : expected) {
        window.choose(path);
        EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{kind}) << path;
    }
}

TEST(MenusOfAnother, ItemsWithoutAFileAskForIt) {
    for (const std::string path :
         {"File/Open...", "File/Save", "File/Save as...", "File/Import as a layer...",
          "File/Import camera...", "File/Export camera...", "File/Export look...", "File/Apply look...",
          "File/Screenshot of the window...", "File/Save the frame as seen...", "View/Load reference..."}) {
        TestWindow window(example_document());
        window.choose(path);
        EXPECT_TRUE(window.has("file/path")) << path;
        window.click("file/Cancel");
        EXPECT_TRUE(window.take_commands().empty()) << path;
        EXPECT_FALSE(window.has("file/path")) << path;
    }
}

TEST_F(MenusTest, NewScenesBeginEmptyOrWithAShape) {
    for (const auto& [path, text] : {std::pair{"File/New/Empty scene", ""}, {"File/New/Ring", "ring"}}) {
        window.choose(path);
        EXPECT_EQ(window.take_only(Kind::new_scene).text, text) << path;
    }
    make_edited(window);
    window.choose("File/New/Ring");
    EXPECT_TRUE(window.take_commands().empty()) << "what is not saved is asked about";
}

TEST_F(MenusTest, AMeshWithoutAPictureOffersToChooseOne) {
    window.view.grey_layer = "stars";
    window.frame(2);
    window.click("notice/Choose a picture...");
    EXPECT_TRUE(window.has("file/path"));
    window.click("file/Cancel");
    window.click("notice/Keep grey");
    EXPECT_TRUE(window.view.grey_layer.empty());
    window.frame(2);
    EXPECT_FALSE(window.has("notice/Keep grey"));
}

TEST_F(MenusTest, RecentFilesOpen) {
    window.choose("File/Open recent/nebula.toml");
    EXPECT_EQ(window.take_only(Kind::open).path, "/scenes/nebula.toml");
}

TEST_F(MenusTest, LayersMoveAsFarAsTheListGoes) {
    const auto names = [&] { return layer_names(window.document.scene()); };
    const std::vector<std::string> before = names();
    ASSERT_EQ(before.size(), 3U);
    for (const auto& [item, layer, after, order] :
         {std::tuple("Layer/Move up", 0U, 0U, before), std::tuple("Layer/Move down", 2U, 2U, before),
          std::tuple("Layer/Move up", 1U, 0U, std::vector{before[1], before[0], before[2]}),
          std::tuple("Layer/Move down", 1U, 2U, std::vector{before[1], before[2], before[0]})}) {
        window.view.layer = layer;
        window.choose(item);
        window.tap(key_code::escape);
        EXPECT_EQ(names(), order) << item << " of " << layer;
        EXPECT_EQ(window.view.layer, after);
    }
}

TEST_F(MenusTest, ADomeMasterIsASquareFisheye) {
    window.choose("Camera/Dome master/4096 px");
    const Scene& scene = window.document.scene();
    EXPECT_EQ(scene.output.width, 4096);
    EXPECT_EQ(scene.output.height, 4096);
    EXPECT_EQ(scene.camera.projection, Projection::fisheye);
    EXPECT_EQ(scene.camera.fisheye_fov, 180.0);
    EXPECT_EQ(window.document.undo_name(), "Dome master of 4096 px");
    EXPECT_TRUE(window.view.safe_areas);
}

TEST_F(MenusTest, CameraMoves) {
    window.view.frame = 240;  // no keyframe of the camera comes later
    window.choose("Camera/Add move/Fly in");
    EXPECT_EQ(window.take_only(Kind::add_move).index, std::size_t(CameraMove::fly_in));
}

TEST_F(MenusTest, ThePanelsMovesAskTheSame) {
    window.view.frame = 24;
    window.view.tab = PanelTab::camera;
    window.frame(2);
    window.click("panel/Add move");
    window.click("panel/Orbit");
    EXPECT_TRUE(window.take_commands().empty());
    EXPECT_EQ(window.view.asked_move, CameraMove::orbit);
}

TEST_F(MenusTest, AMoveAsksAboutLaterKeyframes) {
    window.view.frame = 24;
    window.choose("Camera/Add move/Orbit");
    EXPECT_TRUE(window.take_commands().empty());
    window.keep_screen("move");
    window.click("move/shift");
    window.click("move/Add");
    EXPECT_EQ(window.take_only(Kind::add_move).index, std::size_t(CameraMove::orbit));
    EXPECT_EQ(window.view.later_keys, LaterKeys::shift);
    EXPECT_FALSE(window.view.asked_move);

    window.choose("Camera/Add move/Orbit");
    window.tap(key_code::escape);
    EXPECT_TRUE(window.take_commands().empty());
    EXPECT_FALSE(window.view.asked_move);
}

class SettingsDialogTest : public ExampleWindow {};

// Edit > Settings: every choice of every row is taken, and kept when the dialog closes.
TEST_F(SettingsDialogTest, EveryChoiceCanBeClicked) {
    window.choose("Edit/Settings...");
    for (const SettingRow& row : setting_rows())
        for (std::size_t i = row.choices.size(); i-- > 0;) {
            window.click(std::string("settings/") + row.name + "/" + row.choices[i].label);
            EXPECT_EQ(window.view.settings.*row.value, row.choices[i].value) << row.name;
        }
    EXPECT_NE(window.view.settings, Settings());
    window.click("settings/threads/2");
    window.click("settings/Done");
    EXPECT_FALSE(window.view.settings_open);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::keep_settings});
    EXPECT_EQ(window.view.settings.threads, 2);
}

TEST_F(SettingsDialogTest, TheCacheFolderIsTyped) {
    window.choose("Edit/Settings...");
    window.click("settings/cache_folder");
    window.type("/a/folder");
    EXPECT_EQ(window.view.settings.cache_folder, "/a/folder");
    window.click("settings/Done");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::keep_settings});
}

/// W3C's WCAG 2.1, "relative luminance" and "contrast ratio".
double luminance(ImU32 c) {
    double sum = 0.0;
    for (const auto& [shift, weight] :
         {std::pair{IM_COL32_R_SHIFT, 0.2126}, {IM_COL32_G_SHIFT, 0.7152}, {IM_COL32_B_SHIFT, 0.0722}})
        sum += weight * real::srgb_to_linear(double(c >> shift & 255) / 255.0);
    return sum;
}
double contrast(ImU32 a, ImU32 b) {
    const double one = luminance(a), other = luminance(b);
    return (std::max(one, other) + 0.05) / (std::min(one, other) + 0.05);
}

// The levels AA for normal, AAA for high contrast.
TEST(Contrast, IsAsHighAsSaid) {
    TestWindow window(example_document());
    for (const int level : {0, 1}) {
        set_contrast(level);
        EXPECT_EQ(theme_contrast(), level);
        for (const ImU32 back : {color::window, color::panel, color::field}) {
            EXPECT_GT(contrast(color::text, back), level ? 12.0 : 7.0);
            EXPECT_GT(contrast(color::dim, back), level ? 7.0 : 4.0);
            EXPECT_GT(contrast(color::error, back), level ? 6.0 : 3.0);
        }
        EXPECT_GT(contrast(color::line, color::panel), level ? 3.0 : 1.0) << "WCAG 1.4.11";
        EXPECT_EQ(ImGui::GetStyle().Colors[ImGuiCol_Text].x, color4(color::text).x);
    }
    const ImU32 high = color::dim;
    set_contrast(0);
    EXPECT_NE(color::dim, high);
}

TEST_F(SettingsDialogTest, EscapeClosesAndKeeps) {
    window.choose("Edit/Settings...");
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.settings_open);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::keep_settings});
}

// Where things lie, splitters, and the row of tools.

TEST(Layout, CoversTheWindowWithoutGaps) {
    ViewState view;
    for (const bool panels : {true, false})
        for (const bool snapshots : {true, false}) {
            view.panels = panels;
            view.snapshots_open = snapshots;
            const Layout l = make_layout(view, 1600, 900, 1);
            float area = 0;
            for (const Rect& r :
                 {l.menu, l.tools, l.notice, l.viewport, l.snapshots, l.panel, l.timeline, l.status})
                area += r.width * r.height;
            EXPECT_EQ(area, 1600.0f * 900.0f);
        }
}

TEST(Layout, TheWindowKeepsToItAtOddScales) {
    TestWindow window(example_document(), 1600, 1000, 1.25f);
    const Rect viewport = make_layout(window.view, 1600, 1000, 1.25f).viewport;
    EXPECT_EQ(window.at("frame in view"),
              glm::vec2(viewport.x + viewport.width / 2, viewport.y + viewport.height / 2));
}

TEST(Layout, SplittersAreDraggedAndReset) {
    TestWindow window(example_document());
    window.drag(window.at("panel splitter"), {-100, 0});
    EXPECT_NEAR(window.view.panel_width, 460, 1);
    window.drag(window.at("panel splitter"), {-1000, 0});
    EXPECT_EQ(window.view.panel_width, 520);
    window.double_click(window.at("panel splitter"));
    EXPECT_EQ(window.view.panel_width, 360);
    window.drag(window.at("timeline splitter"), {0, -80});
    EXPECT_NEAR(window.view.timeline_height, 228, 1);
    window.click("fold timeline");
    EXPECT_EQ(make_layout(window.view, 1600, 900, 1).timeline.height, 36);
}

TEST(Layout, APictureOfTheViewportsSizeIsShownPixelByPixel) {
    const Rect viewport{0, 60, 1241, 667};
    const Rect fit = place_frame(ViewState{}, viewport, 1241, 667);
    EXPECT_EQ(fit.x, 0);
    EXPECT_EQ(fit.y, 60);
    EXPECT_EQ(fit.width, 1241);
    ViewState view;
    view.size = SizeMode::one_to_one;
    view.pan_px = {10, -5};
    view.zoom = 2;
    const Rect zoomed = place_frame(view, {0, 0, 1000, 500}, 100, 50);
    EXPECT_EQ(zoomed.x, 410);
    EXPECT_EQ(zoomed.y, 195);
    EXPECT_EQ(zoomed.width, 200);
}

/// In the smallest window, with the longest words.
TEST(Tools, DoNotLieOverEachOther) {
    TestWindow window(example_document(), 900, 600);
    window.status.reference = ReferenceStatus{0, 1.5, ""};
    window.view.compare_with = CompareWith::reference;
    window.view.compare = CompareMode::difference;
    window.frame(2);
    EXPECT_LT(window.at("compare/Diff").x + 30.0f, window.at("more tools").x);
    window.click("more tools");
    EXPECT_TRUE(window.has("compare with"));
    EXPECT_TRUE(window.has("place/Place"));
}

TEST(Tools, ChooseViewSizeAndComparison) {
    TestWindow window(example_document());
    window.click("view/Side");
    EXPECT_EQ(window.view.view, ViewKind::side);
    window.click("view/Camera");
    EXPECT_EQ(window.view.view, ViewKind::camera);
    window.click("size/1:1");
    EXPECT_EQ(window.view.size, SizeMode::one_to_one);
    window.click("compare/A|B");
    EXPECT_EQ(window.view.compare, CompareMode::wipe);
    window.click("compare/Diff");
    EXPECT_EQ(window.view.compare, CompareMode::difference);
}

}  // namespace
}  // namespace astrosplat
