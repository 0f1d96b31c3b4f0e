// Shortcuts pressed over the window: what they change and ask for.
#include "edit/edits.h"
#include "edit/view_camera.h"
#include "gui/panel/panel.h"
#include "gui/parts.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "scene/animate.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

class ShortcutsTest : public ExampleWindow {};

TEST_F(ShortcutsTest, CodesOfLettersAndDigitsAreTheirCharacters) {
    const auto expect_named = [](int code, char character) {
        EXPECT_EQ(code, character);
        EXPECT_EQ(shortcut_text({.code = code}), std::string(1, character));
    };
    expect_named(key_code::n0, '0');
    expect_named(key_code::n1, '1');
    expect_named(key_code::n3, '3');
    expect_named(key_code::n7, '7');
    expect_named(key_code::n9, '9');
    expect_named('Z', 'Z');
    EXPECT_EQ(key_code::space, ' ');
    EXPECT_EQ(shortcut_text({}), "");
    EXPECT_EQ(shortcut_text({.code = 128}), "");
}

TEST_F(ShortcutsTest, UndoAndRedoNameTheirStep) {
    make_edited(window);
    window.click("Edit");
    window.keep_screen("undo_menu");
    window.tap(key_code::escape);
    window.tap('Z', true);
    EXPECT_EQ(window.document.scene().layers[0].render.opacity, 1.0);
    window.tap('Z', true, true);
    EXPECT_EQ(window.document.scene().layers[0].render.opacity, 0.5);
}

TEST_F(ShortcutsTest, WhatIsUndoneIsSaid) {
    make_edited(window);
    const std::string name = window.document.undo_name();
    window.tap('Z', true);
    window.tap('Y', true);
    EXPECT_EQ(window.document.scene().layers[0].render.opacity, 0.5);
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), (std::vector{Command::Kind::say, Command::Kind::say}));
    EXPECT_EQ(commands[0].text, "Undone: " + name);
    EXPECT_EQ(commands[1].text, "Redone: " + name);
}

TEST_F(ShortcutsTest, LayersLooksAndCamerasAreCopiedAndPasted) {
    const Scene before = window.document.scene();
    window.tap('C', true);
    window.view.layer = 2;
    window.tap('V', true);
    ASSERT_EQ(window.document.scene().layers.size(), 4u);
    EXPECT_EQ(window.view.layer, 3u);
    EXPECT_EQ(window.document.undo_name(), "Paste layer");
    EXPECT_EQ(window.document.scene().layers[3].source, before.layers[0].source);
    window.choose("Edit/Copy camera");
    window.document.edit("Lens", [](Scene& scene) { scene.camera.fov = 11.0; });
    window.tap('V', true);
    EXPECT_EQ(window.document.undo_name(), "Paste camera");
    EXPECT_EQ(window.document.scene().camera, before.camera);
    ImGui::SetClipboardText("of another program");
    window.tap('V', true);
    EXPECT_EQ(window.document.undo_name(), "Paste camera") << "nothing";
}

TEST(Menus, TheHistoryGoesToAnyStep) {
    TestWindow window(example_document());
    for (const double opacity : {0.9, 0.8, 0.7})
        window.document.edit("Opacity",
                             [&](Scene& scene) { scene.layers[0].render.opacity = float(opacity); });
    const auto go_to = [&](const char* step) {
        window.choose(std::string("Edit/History/") + step);
        return window.document.scene().layers[0].render.opacity;
    };
    EXPECT_FLOAT_EQ(go_to("1"), 0.9f);
    EXPECT_TRUE(window.document.can_redo());
    EXPECT_FLOAT_EQ(go_to("3"), 0.7f);
    EXPECT_EQ(go_to("0"), 1.0);
    EXPECT_FALSE(window.document.can_undo());
}

/// The scopes that are chosen come and go together; the last one that is let go closes them.
TEST_F(ShortcutsTest, ScopesAreChosenAndShown) {
    using Chosen = std::array<bool, scope_count>;
    ViewState& view = window.view;
    window.tap('V');
    EXPECT_TRUE(view.scopes_open);
    EXPECT_EQ(view.scopes, (Chosen{true, true, true}));
    window.choose("View/Channels and scopes/Waveform");
    EXPECT_EQ(view.scopes, (Chosen{true, false, true}));
    window.tap('V');
    EXPECT_FALSE(view.scopes_open);
    window.choose("View/Channels and scopes/Vectorscope");  // it is not seen: it is asked for
    EXPECT_TRUE(view.scopes_open);
    EXPECT_EQ(view.scopes, (Chosen{true, false, true}));
    window.choose("View/Channels and scopes/Vectorscope");
    window.choose("View/Channels and scopes/Histogram");
    EXPECT_FALSE(view.scopes_open);
    window.tap('V');
    EXPECT_EQ(view.scopes, (Chosen{true, true, true}));
}

class ToolRowTest : public ExampleWindow {};

/// B and the reference are two things, each chosen by name.
TEST_F(ToolRowTest, WhatIsComparedWithIsChosen) {
    window.status.b_snapshot = 0;
    window.click("compare/Diff");
    EXPECT_EQ(window.view.compare_with, CompareWith::b);
    EXPECT_TRUE(window.has("compare with"));
    EXPECT_TRUE(window.has("difference gain"));
    EXPECT_FALSE(window.has("place/Place"));
    EXPECT_TRUE(window.take_commands().empty());
    window.status.reference = ReferenceStatus{0, 1.5, ""};
    window.tap('B', true);
    EXPECT_EQ(window.view.compare_with, CompareWith::reference);
    window.frame();
    window.click("compare/A|Ref");
    EXPECT_EQ(window.view.compare, CompareMode::wipe);
    EXPECT_TRUE(window.has("place/Place"));
    EXPECT_TRUE(window.take_commands().empty());
}

/// One channel alone, and back by the same key; no key of the looks that are compared is lost.
TEST_F(ToolRowTest, ChannelsAndExposureOfTheView) {
    using Channel = Inspection::Channel;
    for (const auto& [key, channel] : {std::pair{'R', Channel::red},
                                       {'G', Channel::green},
                                       {'B', Channel::blue},
                                       {'A', Channel::alpha},
                                       {'L', Channel::luminance},
                                       {'E', Channel::stops}}) {
        window.tap(key, false, true);
        EXPECT_EQ(window.view.inspection.channel, channel) << key;
        EXPECT_EQ(window.view.compare, CompareMode::a);
        window.tap(key, false, true);
        EXPECT_EQ(window.view.inspection.channel, Channel::color) << key;
    }
    window.choose("View/Channels and scopes/Alpha");
    EXPECT_EQ(window.view.inspection.channel, Channel::alpha);
    window.drag(window.at("gamma"), {30, 0});
    window.drag(window.at("exposure"), {30, 0});
    EXPECT_GT(window.view.inspection.gamma, 1.0f);
    EXPECT_GT(window.view.inspection.exposure, 0.0f);
    window.click(window.at("gamma"), 1);
    EXPECT_EQ(window.view.inspection.gamma, 1.0f);
    window.click("neutral");
    EXPECT_EQ(window.view.inspection, Inspection());
    EXPECT_FALSE(window.document.edited()) << "nothing of it is the scene's";
}

TEST_F(ToolRowTest, WhatIsMissingIsAskedForOrSaid) {
    window.click("compare/A|B");
    EXPECT_EQ(window.take_only(Kind::say).text,
              "Nothing is stored as B yet: the key B stores the look as it is");
    window.tap('B', true);
    EXPECT_TRUE(window.has("file/path")) << "there is no reference yet";
}

TEST_F(ToolRowTest, BlinkingHasAKeyAButtonAndARate) {
    window.status.b_snapshot = 0;
    window.tap('X');
    EXPECT_EQ(window.view.compare, CompareMode::blink);
    window.frame();
    window.drag(window.at("blink rate"), {40.0f, 0.0f});
    EXPECT_GT(window.view.blink_hz, 2.5f);
    window.tap('X');
    EXPECT_EQ(window.view.compare, CompareMode::a);
    window.click("compare/Blink");
    EXPECT_EQ(window.view.compare, CompareMode::blink);
}

TEST_F(ShortcutsTest, FramesAndKeyframes) {
    window.tap(key_code::right);
    EXPECT_EQ(window.view.frame, 2.0);
    window.tap(key_code::left);
    window.tap(key_code::left);
    EXPECT_EQ(window.view.frame, 1.0) << "not before the first";
    window.tap(key_code::up);
    EXPECT_EQ(window.view.frame, 24.0);
    window.tap(key_code::down);
    EXPECT_EQ(window.view.frame, 1.0);
    window.tap(key_code::right, true);
    EXPECT_EQ(window.view.frame, 240.0);
    window.tap(key_code::home);
    EXPECT_EQ(window.view.frame, 1.0);
    window.tap(key_code::end);
    EXPECT_EQ(window.view.frame, 240.0);
    EXPECT_TRUE(window.take_commands().empty()) << "the view stays";
    window.tap('F');
    window.tap('F', false, true);
    EXPECT_EQ(kinds(window.take_commands()), (std::vector{Kind::frame_all, Kind::frame_layer}));
    window.tap(key_code::space);
    EXPECT_TRUE(window.view.playing);
    window.tap(key_code::space);
    EXPECT_FALSE(window.view.playing);
}

TEST_F(ShortcutsTest, SetKeyframesOfTheCameraOrTheRowUnderTheMouse) {
    window.view.frame = 50;
    window.tap('K');
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), "camera.position", 50));
    window.tap('K', false, true);
    EXPECT_FALSE(has_keyframe_at(window.document.scene(), "camera.position", 50));
    const std::string gain = "layer.dust.look.alpha.gain";
    for (const DrawnRow& row : window.gui.panel().rows())
        if (row.key == gain) window.move(row.label);
    window.frame();
    window.tap('K');
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), gain, 50));
    EXPECT_FALSE(has_keyframe_at(window.document.scene(), "camera.position", 50));
}

/// The menu, the shortcut and the panel's button mean one thing: a keyframe of what is seen.
TEST(ShortcutsOfAnother, KeyCameraHereIsOneAct) {
    for (const ViewKind kind : {ViewKind::camera, ViewKind::free, ViewKind::front}) {
        const auto scene_after = [&](const auto& act) {
            TestWindow window(example_document());
            window.view.view = kind;
            window.view.free.position = {3.0, 2.0, 20.0};
            window.view.tab = PanelTab::camera;
            window.view.frame = 50;
            window.frame(2);
            act(window);
            window.frame();
            return window.document.scene();
        };
        const Scene by_key = scene_after([](TestWindow& window) { window.tap('K'); });
        const Scene by_menu =
            scene_after([](TestWindow& window) { window.choose("Camera/Key camera here"); });
        const Scene by_button = scene_after([](TestWindow& window) {
            window.click(window.gui.panel().rows().at(0).label - glm::vec2(0.0f, 58.0f));
        });
        Scene wanted = example_document().scene();
        ViewState view;
        view.view = kind;
        view.free.position = {3.0, 2.0, 20.0};
        view.frame = 50;
        set_keyframe_of_seen_camera(wanted, view, example_status());
        EXPECT_EQ(by_key, wanted);
        EXPECT_EQ(by_menu, wanted);
        EXPECT_EQ(by_button, wanted);
    }
}

/// Before the viewport's shape is known, it is the output's.
TEST_F(ShortcutsTest, ThreeQuarterFitsThePicture) {
    const OutputParams& output = window.document.scene().output;
    for (const double aspect : {0.0, 0.5}) {
        window.status.viewport_aspect = aspect;
        const double shape = aspect > 0.0 ? aspect : double(output.width) / double(output.height);
        const FreeCamera wanted = three_quarter_view(window.view.free, window.status.box, shape);
        window.tap(key_code::n9);
        EXPECT_EQ(window.view.free.height, wanted.height);
        EXPECT_EQ(window.view.free.position, wanted.position);
    }
}

TEST_F(ShortcutsTest, ViewsAndSwitches) {
    window.tap(key_code::n7);
    EXPECT_EQ(window.view.view, ViewKind::top);
    window.tap(key_code::n9);
    EXPECT_EQ(window.view.view, ViewKind::free);
    window.tap(key_code::n0);
    EXPECT_EQ(window.view.view, ViewKind::camera);
    window.tap('G');
    EXPECT_FALSE(window.view.gate);
    window.tap('Z');
    EXPECT_EQ(window.view.size, SizeMode::one_to_one);
    window.tap('A');
    EXPECT_EQ(window.view.compare, CompareMode::other);
    window.tap('S');
    EXPECT_EQ(window.view.solo.count("dust"), 1U);
    window.tap('H');
    EXPECT_FALSE(window.document.scene().layers[0].visible);
    window.tap(key_code::f11);
    EXPECT_FALSE(window.view.panels);
    EXPECT_FALSE(window.has("ruler"));
}

TEST_F(ShortcutsTest, HSetsAKeyframeWhereVisibilityIsAnimated) {
    const std::string key = "layer.dust.visible";
    window.document.edit("Animate", [&](Scene& scene) {
        set_keyframe(scene, key, 1.0, true);
        set_keyframe(scene, key, 100.0, false);
    });
    const auto seen = [&] { return scene_at(window.document.scene(), window.view.frame).layers[0].visible; };
    window.view.frame = 50.0;
    window.tap('H');
    EXPECT_FALSE(seen());
    EXPECT_EQ(window.document.undo_name(), "Hide dust");
    window.view.frame = 120.0;
    window.choose("Layer/Visible");
    EXPECT_TRUE(seen());
    EXPECT_EQ(window.document.undo_name(), "Show dust");
    EXPECT_EQ(find_track(window.document.scene(), key)->keyframes.size(), 4U);
}

TEST_F(ShortcutsTest, TheSheetOpensAndCloses) {
    window.tap(key_code::f1);
    EXPECT_TRUE(window.has("shortcuts/Close"));
    window.tap(key_code::f1);
    EXPECT_FALSE(window.view.help_open);
    window.tap(key_code::f1);
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.help_open);
    window.tap(key_code::f1);
    window.click("shortcuts/Close");
    EXPECT_FALSE(window.view.help_open);
}

TEST_F(ShortcutsTest, AreLettersWhereTextIsTyped) {
    window.double_click(window.at("frame"));
    window.tap('G');
    window.tap(key_code::space);
    EXPECT_TRUE(window.view.gate);
    EXPECT_FALSE(window.view.playing);
}

TEST_F(ShortcutsTest, EscapeCancelsTheJob) {
    window.status.jobs.push_back(running_job_of("frame 3 (3/240)", 0.01f));
    window.tap(key_code::escape);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::cancel_render});
}

// Two actions with one shortcut would make one of them unreachable.
TEST_F(ShortcutsTest, NoneMeansTwoThings) {
    std::map<std::string, std::string> seen;
    for (const Action& action : actions())
        for (const Shortcut& shortcut : {action.shortcut, action.also}) {
            const std::string text = shortcut_text(shortcut);
            if (text.empty()) continue;
            EXPECT_TRUE(seen.emplace(text, action.label).second)
                << text << ": " << seen[text] << ", " << action.label;
        }
}

}  // namespace
}  // namespace astrosplat
