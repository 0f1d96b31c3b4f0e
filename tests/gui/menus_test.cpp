// Menus: every item can be reached and becomes its command, or a question for a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "edit/camera_moves.h"
#include "gui/actions.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

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
        window.tap(key_code::escape);
        window.tap(key_code::escape);
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
          "File/Import as a layer...", "File/Import camera...", "File/Export camera...",
          "File/Export look...", "File/Apply look...", "File/Screenshot of the window...",
          "File/Save the frame as seen...", "View/Load reference..."}) {
        TestWindow window(example_document());
        window.choose(path);
        window.frame(2);
        EXPECT_TRUE(window.has("file/path")) << path;
        window.click("file/Cancel");
        EXPECT_TRUE(window.take_commands().empty()) << path;
        EXPECT_FALSE(window.has("file/path")) << path;
    }
}

TEST(Menus, NewScenesBeginEmptyOrWithAShape) {
    TestWindow window(example_document());
    for (const auto& [path, text] : {std::pair{"File/New/Empty scene", ""}, {"File/New/Ring", "ring"}}) {
        window.click("File");
        window.move(window.at("File/New"));
        window.frame(30);
        window.click(path);
        const Commands commands = window.take_commands();
        ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::new_scene}) << path;
        EXPECT_EQ(commands[0].text, text);
    }
    make_edited(window);
    window.click("File");
    window.move(window.at("File/New"));
    window.frame(30);
    window.click("File/New/Ring");
    EXPECT_TRUE(window.take_commands().empty()) << "what is not saved is asked about";
}

TEST(Menus, AMeshWithoutAPictureOffersToChooseOne) {
    TestWindow window(example_document());
    window.view.grey_layer = "stars";
    window.frame(2);
    window.click("notice/Choose a picture...");
    window.frame(2);
    EXPECT_TRUE(window.has("file/path"));
    window.click("file/Cancel");
    window.click("notice/Keep grey");
    EXPECT_TRUE(window.view.grey_layer.empty());
    window.frame(2);
    EXPECT_FALSE(window.has("notice/Keep grey"));
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

TEST(Menus, LayersMoveAsFarAsTheListGoes) {
    TestWindow window(example_document());
    const auto names = [&] {
        std::vector<std::string> list;
        for (const LayerParams& layer : window.document.scene().layers) list.push_back(layer.name);
        return list;
    };
    const std::vector<std::string> before = names();
    ASSERT_EQ(before.size(), 3U);
    for (const auto& [item, layer, after, order] :
         {std::tuple("Layer/Move up", 0U, 0U, before), std::tuple("Layer/Move down", 2U, 2U, before),
          std::tuple("Layer/Move up", 1U, 0U, std::vector{before[1], before[0], before[2]}),
          std::tuple("Layer/Move down", 1U, 2U, std::vector{before[1], before[2], before[0]})}) {
        window.view.layer = layer;
        window.choose(item);
        window.tap(key_code::escape);
        window.frame(2);
        EXPECT_EQ(names(), order) << item << " of " << layer;
        EXPECT_EQ(window.view.layer, after);
    }
}

void choose_move(TestWindow& window, const std::string& name) {
    window.click("Camera");
    window.move(window.at("Camera/Add move"));
    window.frame(30);
    window.click("Camera/Add move/" + name);
    window.frame(3);
}

TEST(Menus, ADomeMasterIsASquareFisheye) {
    TestWindow window(example_document());
    window.click("Camera");
    window.move(window.at("Camera/Dome master"));
    window.frame(30);
    window.click("Camera/Dome master/4096 px");
    window.frame(3);
    const Scene& scene = window.document.scene();
    EXPECT_EQ(scene.output.width, 4096);
    EXPECT_EQ(scene.output.height, 4096);
    EXPECT_EQ(scene.camera.projection, Projection::fisheye);
    EXPECT_EQ(scene.camera.fisheye_fov, 180.0);
    EXPECT_EQ(window.document.undo_name(), "Dome master of 4096 px");
    EXPECT_TRUE(window.view.safe_areas);
}

TEST(Menus, CameraMoves) {
    TestWindow window(example_document());
    window.view.frame = 240;  // no keyframe of the camera comes later
    choose_move(window, "Fly in");
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::add_move});
    EXPECT_EQ(commands[0].index, static_cast<std::size_t>(CameraMove::fly_in));
}

TEST(Menus, AMoveAsksAboutLaterKeyframes) {
    TestWindow window(example_document());
    window.view.frame = 24;
    choose_move(window, "Orbit");
    EXPECT_TRUE(window.take_commands().empty());
    window.keep_screen("move");
    window.click("move/shift");
    window.click("move/Add");
    window.frame(2);
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), std::vector<Kind>{Kind::add_move});
    EXPECT_EQ(commands[0].index, static_cast<std::size_t>(CameraMove::orbit));
    EXPECT_EQ(window.view.later_keys, LaterKeys::shift);
    EXPECT_FALSE(window.view.asked_move);

    choose_move(window, "Orbit");
    window.tap(key_code::escape);
    window.frame(2);
    EXPECT_TRUE(window.take_commands().empty());
    EXPECT_FALSE(window.view.asked_move);
}

}  // namespace
}  // namespace astrosplat
