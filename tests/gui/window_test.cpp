// The window as a person uses it: mouse and keys in, edits, view and commands out.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "edit/keys.h"
#include "gui/actions.h"
#include "gui/gui_frame.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"
#include "gui/viewport.h"
#include "gui/viewport_overlay.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

void make_edited(TestWindow& window) {
    window.document.edit("Opacity of dust", [](Scene& scene) { scene.layers[0].render.opacity = 0.5; });
    window.frame();
}

std::vector<Kind> kinds(const Commands& commands) {
    std::vector<Kind> list;
    for (const Command& command : commands) list.push_back(command.kind);
    return list;
}

// --- keys

TEST(Keys, UndoAndRedoNameTheirStep) {
    TestWindow window(example_document());
    make_edited(window);
    window.click("Edit");
    window.keep_picture("undo_menu");
    window.key(key_code::escape);
    window.key('Z', true);
    EXPECT_EQ(window.document.scene().layers[0].render.opacity, 1.0);
    window.key('Z', true, true);
    EXPECT_EQ(window.document.scene().layers[0].render.opacity, 0.5);
}

TEST(Keys, FramesAndKeys) {
    TestWindow window(example_document());
    window.key(key_code::right);
    EXPECT_EQ(window.view.frame, 2.0);
    window.key(key_code::left);
    window.key(key_code::left);
    EXPECT_EQ(window.view.frame, 1.0) << "not before the first";
    window.key(key_code::up);
    EXPECT_EQ(window.view.frame, 24.0);
    window.key(key_code::down);
    EXPECT_EQ(window.view.frame, 1.0);
    window.key(key_code::right, true);
    EXPECT_EQ(window.view.frame, 240.0);
    window.key(key_code::space);
    EXPECT_TRUE(window.view.playing);
    window.key(key_code::space);
    EXPECT_FALSE(window.view.playing);
}

TEST(Keys, KeysTheCameraOrTheRowUnderTheMouse) {
    TestWindow window(example_document());
    window.view.frame = 50;
    window.key('K');
    EXPECT_TRUE(has_key_at(window.document.scene(), "camera.position", 50));
    window.key('K', false, true);
    EXPECT_FALSE(has_key_at(window.document.scene(), "camera.position", 50));
}

TEST(Keys, ViewsAndSwitches) {
    TestWindow window(example_document());
    window.key(key_code::n7);
    EXPECT_EQ(window.view.view, ViewKind::top);
    window.key(key_code::n9);
    EXPECT_EQ(window.view.view, ViewKind::free);
    window.key(key_code::n0);
    EXPECT_EQ(window.view.view, ViewKind::camera);
    window.key('G');
    EXPECT_FALSE(window.view.gate);
    window.key('Z');
    EXPECT_EQ(window.view.size, SizeMode::one_to_one);
    window.key(key_code::tab);
    EXPECT_EQ(window.view.compare, CompareMode::b);
    window.key('S');
    EXPECT_EQ(window.view.solo.count("dust"), 1U);
    window.key('H');
    EXPECT_FALSE(window.document.scene().layers[0].visible);
    window.key(key_code::f11);
    EXPECT_FALSE(window.view.panels);
    EXPECT_FALSE(window.has("ruler"));
}

TEST(Keys, TheSheetOpensAndCloses) {
    TestWindow window(example_document());
    window.key(key_code::f1);
    EXPECT_TRUE(window.has("keys/Close"));
    window.key(key_code::f1);
    EXPECT_FALSE(window.view.help_open);
    window.key(key_code::f1);
    window.key(key_code::escape);
    EXPECT_FALSE(window.view.help_open);
    window.key(key_code::f1);
    window.click("keys/Close");
    EXPECT_FALSE(window.view.help_open);
}

TEST(Keys, AreLettersWhereTextIsTyped) {
    TestWindow window(example_document());
    window.double_click(window.at("frame"));
    window.key('G');
    window.key(key_code::space);
    EXPECT_TRUE(window.view.gate);
    EXPECT_FALSE(window.view.playing);
}

TEST(Keys, EscapeCancelsTheJob) {
    TestWindow window(example_document());
    window.status.job = {"Rendering 3 of 240", 0.01f};
    window.key(key_code::escape);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::cancel_render});
}

// Two actions with one key would make one of them unreachable.
TEST(Keys, NoneMeansTwoThings) {
    std::map<std::string, std::string> seen;
    for (const Action& action : actions()) {
        const std::string text = shortcut_text(action.shortcut);
        if (text.empty()) continue;
        EXPECT_TRUE(seen.emplace(text, action.label).second)
            << text << ": " << seen[text] << ", " << action.label;
    }
}

// --- menus

TEST(Menus, EveryItemCanBeReached) {
    TestWindow window(example_document());
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
        window.key(key_code::escape);
        window.key(key_code::escape);
        window.frame(2);
    }
}

TEST(Menus, ItemsBecomeCommands) {
    const std::vector<std::pair<std::string, Kind>> expected{
        {"File/Open the demo", Kind::open_demo},
        {"Edit/Store as B", Kind::store_b},
        {"Edit/Take snapshot", Kind::take_snapshot},
        {"View/Frame layer", Kind::frame_layer},
        {"View/Frame all", Kind::frame_all},
        {"Render/Range", Kind::render_range},
        {"Render/Copy batch command", Kind::copy_batch_command},
        {"File/Quit", Kind::quit}};
    TestWindow window(example_document());
    for (const auto& [path, kind] : expected) {
        window.choose(path);
        window.frame();
        EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{kind}) << path;
    }
}

TEST(Menus, ItemsWithoutAFileAskForIt) {
    for (const std::string path :
         {"File/New from picture...", "File/Open...", "File/Save", "File/Save as...",
          "File/Import as a layer...", "File/Export look...", "File/Apply look...", "File/Screenshot...",
          "View/Load reference...", "Render/This frame...", "Render/Movie..."}) {
        TestWindow window(example_document());
        window.choose(path);
        window.frame(2);
        EXPECT_TRUE(window.has("file/path")) << path;
        window.click("file/Cancel");
        EXPECT_TRUE(window.take_commands().empty()) << path;
        EXPECT_FALSE(window.has("file/path")) << path;
    }
}

TEST(Menus, RecentFilesOpen) {
    TestWindow window(example_document());
    window.click("File");
    window.move(window.at("File/Open recent"));
    window.frame(30);
    window.click("File/Open recent/nebula.toml");
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::open});
    EXPECT_EQ(commands[0].path, "/scenes/nebula.toml");
}

TEST(Menus, CameraMoves) {
    TestWindow window(example_document());
    window.click("Camera");
    window.move(window.at("Camera/Add move"));
    window.frame(30);
    window.click("Camera/Add move/Fly in");
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::add_move});
    EXPECT_EQ(commands[0].index, static_cast<std::size_t>(CameraMove::fly_in));
}

// --- timeline

TEST(Timeline, ThePlayheadIsDragged) {
    TestWindow window(example_document());
    const glm::vec2 first = window.at("key camera.position 1"), later = window.at("key camera.position 90");
    const float y = window.at("ruler").y;
    window.view.playing = true;
    window.drag({first.x, y}, {later.x - first.x, 0});
    EXPECT_EQ(window.view.frame, 90.0);
    EXPECT_FALSE(window.view.playing);
    window.drag({first.x, y}, {-2000, 0});
    EXPECT_EQ(window.view.frame, 1.0);
}

TEST(Timeline, AFrameIsTyped) {
    TestWindow window(example_document());
    window.double_click(window.at("frame"));
    window.key('A', true);
    window.type("137");
    window.key(key_code::enter);
    EXPECT_EQ(window.view.frame, 137.0);
}

TEST(Timeline, AKeyMovesWithTheMouse) {
    TestWindow window(example_document());
    const std::string power = "layer.dust.look.alpha.power";
    const glm::vec2 from = window.at("key " + power + " 90"), to = window.at("key camera.position 240");
    const float per_frame = (to.x - from.x) / 150.0f;
    window.drag(from, {20 * per_frame, 0});
    EXPECT_TRUE(has_key_at(window.document.scene(), power, 110));
    EXPECT_FALSE(has_key_at(window.document.scene(), power, 90));
    EXPECT_EQ(find_track(window.document.scene(), power)->keys.size(), 3U);
    window.key('Z', true);
    EXPECT_TRUE(has_key_at(window.document.scene(), power, 90)) << "one drag is one step";
    EXPECT_FALSE(window.document.can_undo());
}

TEST(Timeline, CtrlDragCopiesAndDeleteRemoves) {
    TestWindow window(example_document());
    const std::string opacity = "layer.stars.render.opacity";
    const glm::vec2 from = window.at("key " + opacity + " 120"), to = window.at("key camera.position 240");
    window.hold(true, false, false);
    window.drag(from, {to.x - from.x, 0});
    window.hold(false, false, false);
    EXPECT_TRUE(has_key_at(window.document.scene(), opacity, 120));
    EXPECT_TRUE(has_key_at(window.document.scene(), opacity, 240));
    window.key(key_code::del);
    EXPECT_FALSE(has_key_at(window.document.scene(), opacity, 240)) << "the copy was selected";
    EXPECT_TRUE(has_key_at(window.document.scene(), opacity, 120));
}

TEST(Timeline, ABoxSelectsAndMovesTogether) {
    TestWindow window(example_document());
    const glm::vec2 camera = window.at("key camera.position 90");
    const glm::vec2 opacity = window.at("key layer.stars.render.opacity 120");
    window.drag({camera.x - 20, camera.y - 8},
                glm::vec2(opacity.x + 20, opacity.y + 8) - glm::vec2(camera.x - 20, camera.y - 8));
    window.key(key_code::del);
    const Scene& scene = window.document.scene();
    EXPECT_FALSE(has_key_at(scene, "camera.position", 90));
    EXPECT_FALSE(has_key_at(scene, "layer.dust.look.alpha.power", 90));
    EXPECT_FALSE(has_key_at(scene, "layer.stars.render.opacity", 120));
    EXPECT_TRUE(has_key_at(scene, "camera.position", 240));
}

TEST(Timeline, TheMenuOfAKeyChangesItsInterpolation) {
    TestWindow window(example_document());
    window.click(window.at("key layer.stars.render.opacity 24"), 1);
    window.frame();
    window.click("key menu/Step");
    const Track* track = find_track(window.document.scene(), "layer.stars.render.opacity");
    ASSERT_NE(track, nullptr);
    EXPECT_EQ(track->keys[0].interpolation, Interpolation::step);
    EXPECT_EQ(track->keys[1].interpolation, Interpolation::linear);
}

TEST(Timeline, TheGraphDragsAValue) {
    TestWindow window(example_document());
    window.click("graph");
    window.frame(2);
    const std::string power = "layer.dust.look.alpha.power";
    window.click("track " + power);
    window.frame(2);
    const glm::vec2 middle = window.at("graph " + power + " 90 0"),
                    low = window.at("graph " + power + " 1 0");
    // Half way down from 2.5 to 1.0.
    window.drag(middle, {0, (low.y - middle.y) * 0.5f});
    EXPECT_NEAR(find_track(window.document.scene(), power)->keys[1].value[0], 1.75, 0.02);
    window.key('Z', true);
    EXPECT_EQ(find_track(window.document.scene(), power)->keys[1].value[0], 2.5);
}

// --- layout and tools

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
    const Rect fit = place_picture(ViewState{}, viewport, 1241, 667);
    EXPECT_EQ(fit.x, 0);
    EXPECT_EQ(fit.y, 60);
    EXPECT_EQ(fit.width, 1241);
    ViewState view;
    view.size = SizeMode::one_to_one;
    view.pan_px = {10, -5};
    view.zoom = 2;
    const Rect zoomed = place_picture(view, {0, 0, 1000, 500}, 100, 50);
    EXPECT_EQ(zoomed.x, 410);
    EXPECT_EQ(zoomed.y, 195);
    EXPECT_EQ(zoomed.width, 200);
}

TEST(Tools, ChooseViewSizeAndComparison) {
    TestWindow window(example_document());
    window.click("view/Side");
    EXPECT_EQ(window.view.view, ViewKind::side);
    window.click("size/1:1");
    EXPECT_EQ(window.view.size, SizeMode::one_to_one);
    window.click("compare/A|B");
    EXPECT_EQ(window.view.compare, CompareMode::wipe);
    window.click("compare/Diff");
    window.frame(2);
    EXPECT_TRUE(window.has("file/path")) << "there is no reference yet";
}

// --- picture

TEST(Picture, MouseButtonsMeanDrags) {
    using Drag = ViewportInput::Drag;
    EXPECT_EQ(drag_of(0, false, false), Drag::orbit);
    EXPECT_EQ(drag_of(0, true, false), Drag::pan);
    EXPECT_EQ(drag_of(2, false, false), Drag::pan);
    EXPECT_EQ(drag_of(1, false, false), Drag::look);
    EXPECT_EQ(drag_of(0, false, true), Drag::orbit);
    EXPECT_EQ(drag_of(2, false, true), Drag::pan);
    EXPECT_EQ(drag_of(1, false, true), Drag::dolly);
}

TEST(Picture, ADragBeginsMovesAndEnds) {
    TestWindow window(example_document());
    const glm::vec2 middle = window.at("picture");
    window.move(middle);
    window.frame(2);
    EXPECT_TRUE(window.gui.viewport_input().hovered);
    window.press(0);
    EXPECT_TRUE(window.gui.viewport_input().drag_begins);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::orbit);
    window.move(middle + glm::vec2(30, -10));
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().delta_px, glm::dvec2(30, -10));
    EXPECT_FALSE(window.gui.viewport_input().drag_begins);
    window.release(0);
    EXPECT_TRUE(window.gui.viewport_input().drag_ends);
    window.frame();
    EXPECT_FALSE(window.gui.viewport_input().drag_ends);
}

TEST(Picture, KeysFlyOnlyWhileLookingAround) {
    TestWindow window(example_document());
    window.move(window.at("picture"));
    window.frame(2);
    ImGui::GetIO().KeysDown['W'] = true;
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().fly, glm::dvec3(0));
    window.press(1);
    window.hold(false, true, false);
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().fly, glm::dvec3(0, 0, 1));
    EXPECT_EQ(window.gui.viewport_input().speed, 10.0);
    ImGui::GetIO().KeysDown['W'] = false;
    ImGui::GetIO().KeysDown['S'] = true;
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().fly, glm::dvec3(0, 0, -1));
    EXPECT_TRUE(window.view.solo.empty()) << "S flies, it does not solo";
    ImGui::GetIO().KeysDown['S'] = false;
    window.release(1);
}

TEST(Picture, TheWipeIsDragged) {
    TestWindow window(example_document());
    window.view.compare = CompareMode::wipe;
    window.frame();
    const glm::vec2 middle = window.at("picture");
    window.drag(middle, {200, 0});
    EXPECT_GT(window.view.wipe, 0.6f);
    EXPECT_LT(window.view.wipe, 0.7f);
}

TEST(Picture, OneToOneZoomsAboutTheMouseAndMoves) {
    TestWindow window(example_document());
    window.view.size = SizeMode::one_to_one;
    const glm::vec2 middle = window.at("picture");
    window.move(middle + glm::vec2(100, 0));
    window.frame(2);
    for (int i = 0; i < 4; ++i) window.wheel(1);
    EXPECT_NEAR(window.view.zoom, 2.0, 1e-9);
    EXPECT_NEAR(window.view.pan_px.x, -100, 1) << "what lies under the mouse stays";
    EXPECT_EQ(window.gui.viewport_input().wheel, 0.0f) << "the camera does not move";
    window.view.pan_px = {0, 0};
    window.drag(middle, {40, 20}, 2);
    EXPECT_EQ(window.view.pan_px, glm::dvec2(40, 20));
}

TEST(Picture, TheBadgeSaysHowFinalItIs) {
    const Document document = example_document();
    Status status = example_status();
    EXPECT_EQ(badge_text(document.scene(), status).text, "Refining 41 %");
    status.picture.state = PictureState::preview;
    EXPECT_EQ(badge_text(document.scene(), status).text, "Preview 240 k of 12.4 M");
    EXPECT_TRUE(badge_text(document.scene(), status).warns);
    status.picture.shown = 2000000;
    EXPECT_FALSE(badge_text(document.scene(), status).warns);
    status.picture.state = PictureState::final;
    status.picture.seconds = 1.8;
    EXPECT_EQ(badge_text(document.scene(), status).text, "Final 1.8 s");
    status.layers[1].loading = true;
    status.layers[1].progress = 0.37f;
    status.layers[1].found = 3100000;
    EXPECT_EQ(badge_text(document.scene(), status).text, "Generating stars 37 %");
    EXPECT_EQ(badge_text(document.scene(), status).beside, "3.1 M splats");
}

TEST(Picture, TheBadgesButtons) {
    TestWindow window(example_document());
    window.status.picture.state = PictureState::failed;
    window.status.picture.error = "no such picture";
    window.frame(2);
    window.click("badge/Copy");
    Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::copy_text});
    EXPECT_EQ(commands[0].text, "no such picture");
    window.status.layers[1].loading = true;
    window.frame(2);
    window.click("badge/Cancel");
    commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::cancel_load});
    EXPECT_EQ(commands[0].index, 1U);
}

TEST(Picture, CountsHaveThreeDigitsAtMost) {
    EXPECT_EQ(short_count(999), "999");
    EXPECT_EQ(short_count(1000), "1.0 k");
    EXPECT_EQ(short_count(9949), "9.9 k");
    EXPECT_EQ(short_count(240000), "240 k");
    EXPECT_EQ(short_count(999499), "999 k");
    EXPECT_EQ(short_count(999600), "1.0 M");
    EXPECT_EQ(short_count(12400000), "12.4 M");
    EXPECT_EQ(short_count(2500000000), "2.5 G");
}

// --- unsaved changes, recovery, messages

TEST(Quit, AsksOnlyAboutUnsavedChanges) {
    TestWindow window(example_document());
    window.key('Q', true);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::quit});
    make_edited(window);
    window.gui.ask_to_quit(window.document);
    window.frame(2);
    EXPECT_TRUE(window.take_commands().empty());
    window.click("unsaved/Cancel");
    EXPECT_TRUE(window.take_commands().empty());
    EXPECT_FALSE(window.has("unsaved/Cancel"));
    window.key('Q', true);
    window.frame();
    window.click("unsaved/Don't save");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::quit});
}

TEST(Quit, SavesFirstAndLeavesOnlyWhenThatWorked) {
    const TempFolder folder;
    const auto file = folder.file("a.toml", example_document().text_for(folder / "a.toml"));
    TestWindow window(Document::open(file));
    window.document.edit("Fps", [](Scene& scene) { scene.output.fps = 30; });
    window.key('Q', true);
    window.frame();
    window.click("unsaved/Save");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::save}) << "the save failed: it stays";
    window.frame(5);
    EXPECT_TRUE(window.take_commands().empty());
    window.key('Q', true);
    window.frame();
    window.move(window.at("unsaved/Save"));
    window.frame(2);
    window.press();
    window.release();
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::save});
    window.document.save();
    window.frame();
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::quit});
}

TEST(Quit, AnUntitledSceneIsAskedForItsFile) {
    const TempFolder folder;
    TestWindow window(example_document());
    make_edited(window);
    window.key('Q', true);
    window.frame();
    window.key(key_code::enter);  // Save
    window.frame(2);
    ASSERT_TRUE(window.has("file/path"));
    window.key('A', true);
    window.type((folder.path() / "new.toml").string());
    window.click("file/Save");
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::save_as});
    EXPECT_EQ(commands[0].path, folder.path() / "new.toml");
}

TEST(Recovery, OffersTheAutosaveOnce) {
    TestWindow window(example_document());
    window.status.recoveries = {"/state/whirlpool.toml"};
    window.frame(2);
    window.click("recovery/Recover");
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::recover});
    EXPECT_EQ(commands[0].path, "/state/whirlpool.toml");
    window.frame(3);
    EXPECT_FALSE(window.has("recovery/Recover"));
}

TEST(ChangedOnDisk, ReloadsOrKeeps) {
    TestWindow window(example_document());
    window.status.changed_on_disk = true;
    window.frame(2);
    window.click("notice/Reload");
    window.click("notice/Keep");
    EXPECT_EQ(kinds(window.take_commands()), (std::vector<Kind>{Kind::reload, Kind::keep}));
    window.status.changed_on_disk = false;
    window.frame(2);
    EXPECT_FALSE(window.has("notice/Keep"));
}

TEST(FirstStart, TheHintIsDismissed) {
    TestWindow window(example_document());
    window.view.hint_open = true;
    window.frame(2);
    window.click("close hint");
    EXPECT_FALSE(window.view.hint_open);
}

TEST(Snapshots, BecomeBAndAreTaken) {
    TestWindow window(example_document());
    window.view.snapshots_open = true;
    window.status.snapshots = {{"One", nullptr, 1.78f, 100, 0.5}, {"Two", nullptr, 1.78f, 100, 0}};
    window.frame(2);
    window.click("snapshot 1");
    window.click("take snapshot");
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), (std::vector<Kind>{Kind::compare_snapshot, Kind::take_snapshot}));
    EXPECT_EQ(commands[0].index, 1U);
    window.click(window.at("snapshot 0"), 1);
    window.frame();
    window.click("snapshot/Restore");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::restore_snapshot});
}

}  // namespace
}  // namespace astrosplat
