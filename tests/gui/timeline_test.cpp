// The timeline and its graph by mouse and keys.
#include "gui/timeline.h"
#include "edit/edits.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "scene/load.h"
#include "support/test.h"

namespace astrosplat {
namespace {

class TimelineTest : public ExampleWindow {};

TEST_F(TimelineTest, TheTargetsDistanceIsSaidWhereAUnitHasALength) {
    Scene scene;
    scene.camera.position = glm::dvec3(0.0, 3.0, 4.0);
    EXPECT_EQ(distance_text(scene, 1.0, {}), "");
    scene.light_years_per_unit = 2000.0;
    EXPECT_EQ(distance_text(scene, 1.0, {}), "target at 5 scene units, 10 kly");
    scene.animation.push_back(
        parse_scene("astrosplat = 1\n[animation]\n\"camera.position\" = { keys = [[1, [0, 3, 4]], [25, [12, "
                    "3, 4]]], interpolation = \"linear\" }\n",
                    "/s.toml")
            .animation.at(0));
    EXPECT_HAS(distance_text(scene, 13.0, {}), " units, 15.6 kly; 24 kly/s") << "12 units a second";
    EXPECT_HAS(distance_text(scene, 1.0, {}), "; 24 kly/s") << "it has begun to move";
    EXPECT_EQ(distance_text(scene, 40.0, {}).find("/s"), std::string::npos) << "it has come to rest";
    scene.animation.clear();
    scene.camera.target = *scene.camera.position;
    EXPECT_EQ(distance_text(scene, 1.0, {}), "") << "no camera stands in its own target";
    const auto header = [&] {
        window.frame(2);
        const Rect area = make_layout(window.view, 1600.0f, 900.0f, 1.0f).timeline;
        return cropped(window.picture(Style::schematic), {int(area.x), int(area.y), int(area.width), 36})
            .pixels;
    };
    const auto plain = header();
    window.document.edit("Scale", [](Scene& edited) { edited.light_years_per_unit = 2000.0; });
    EXPECT_FALSE(header() == plain);
}

// The timeline by mouse: playhead, keyframes, their menu and the graph.
TEST_F(TimelineTest, ThePlayheadIsDragged) {
    const glm::vec2 first = window.at("keyframe camera.position 1"),
                    later = window.at("keyframe camera.position 90");
    const float y = window.at("ruler").y;
    window.view.playing = true;
    window.drag({first.x, y}, {later.x - first.x, 0});
    EXPECT_EQ(window.view.frame, 90.0);
    EXPECT_FALSE(window.view.playing);
    window.drag({first.x, y}, {-2000, 0});
    EXPECT_EQ(window.view.frame, 1.0);
}

TEST_F(TimelineTest, AFrameIsTyped) {
    window.double_click(window.at("frame"));
    window.tap('A', true);
    window.type("137");
    window.tap(key_code::enter);
    EXPECT_EQ(window.view.frame, 137.0);
}

TEST(TimelineOfAnother, AStillIsAsLongAsTheFilmThatItMayBecome) {
    TestWindow window(Document::untitled("astrosplat = 1\n[output]\nframes = \"1\"\n", "/scene.toml"));
    window.view.view = ViewKind::free;
    const glm::vec2 ruler = window.at("ruler");
    window.drag(ruler, {2000, 0});
    EXPECT_EQ(window.view.frame, 240.0);
    window.tap('K');
    EXPECT_EQ(window.document.scene().output.frames, "1-240");
    window.drag(ruler, {-2000, 0});
    EXPECT_EQ(window.view.frame, 1.0);
}

TEST_F(TimelineTest, ThePlayheadComesAlongWhereUndoTakesItsFrameAway) {
    window.document.edit("Longer", [](Scene& scene) { scene.output.frames = "1-400"; });
    window.frame(2);
    window.view.frame = 390.0;
    window.frame(2);
    window.tap('Z', true);
    EXPECT_EQ(window.view.frame, 240.0);
}

TEST_F(TimelineTest, AKeyframeMovesWithTheMouse) {
    const std::string power = "layer.dust.look.alpha.power";
    const glm::vec2 from = window.at("keyframe " + power + " 90"),
                    to = window.at("keyframe camera.position 240");
    const float per_frame = (to.x - from.x) / 150.0f;
    window.drag(from, {20 * per_frame, 0});
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), power, 110));
    EXPECT_FALSE(has_keyframe_at(window.document.scene(), power, 90));
    EXPECT_EQ(find_track(window.document.scene(), power)->keyframes.size(), 3U);
    window.tap('Z', true);
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), power, 90)) << "one drag is one step";
    EXPECT_FALSE(window.document.can_undo());
}

TEST_F(TimelineTest, KeyframesOfTheFirstAndTheLastRowMoveToo) {
    const auto at = [&](const char* key) { return window.at(std::string("keyframe ") + key); };
    const float per_frame = (at("camera.position 240").x - at("camera.position 90").x) / 150.0f;
    window.drag(at("camera.position 90"), {20 * per_frame, 0});
    window.drag(at("layer.stars.render.opacity 24"), {20 * per_frame, 0});
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), "camera.position", 110));
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), "layer.stars.render.opacity", 44));
}

/// The same scene looks the same, whether it was opened so or edited while it was shown.
TEST(TimelineOfAnother, ShowsTheSceneAsItIsNow) {
    const auto pictures = [](bool shown_before) {
        const auto edit = [&](Document& document) {
            document.edit("Keyframes", [](Scene& scene) {
                set_keyframe(scene, "layer.stars.render.opacity", 120, 0.4);
                set_keyframe(scene, "layer.nebulae.render.opacity", 60, 0.5);
            });
        };
        Document document = example_document();
        if (!shown_before) edit(document);
        TestWindow window(std::move(document));
        window.click("graph");
        window.click("track layer.stars.render.opacity");
        if (shown_before) edit(window.document);
        window.frame(2);
        std::vector<Picture8> seen;
        for (const std::string track : {"", "track layer.nebulae.render.opacity"}) {
            if (!track.empty()) window.click(track);
            window.move({-100, -100});
            window.frame(3);
            seen.push_back(window.picture(Style::schematic));
        }
        return seen;
    };
    const std::vector<Picture8> edited = pictures(true), opened = pictures(false);
    for (std::size_t i = 0; i < edited.size(); ++i) EXPECT_TRUE(edited[i].pixels == opened[i].pixels) << i;
}

TEST(TimelineOfAnother, EveryInterpolationHasAMarkOfItsOwn) {
    std::vector<std::vector<Rgba8>> marks;
    for (const int interpolation : {-1, 0, 1, 2}) {
        TestWindow window(example_document());
        const std::string opacity = "layer.stars.render.opacity";
        const glm::vec2 place = window.at("keyframe " + opacity + " 24");
        window.document.edit("Keyframes", [&](Scene& scene) {
            if (interpolation < 0)
                remove_keyframe(scene, opacity, 24);
            else
                set_interpolation(scene, opacity, 24, static_cast<Interpolation>(interpolation));
        });
        window.frame(2);
        const Picture8 mark =
            cropped(window.picture(Style::schematic), {int(place.x) - 4, int(place.y) - 4, 9, 9});
        for (const auto& other : marks) EXPECT_FALSE(mark.pixels == other) << interpolation;
        marks.push_back(mark.pixels);
    }
    const auto middle = [&](std::size_t i) { return marks[i][4 * 9 + 4]; };
    EXPECT_FALSE(middle(1) == middle(0));
    for (const std::size_t i : {2u, 3u}) EXPECT_TRUE(middle(i) == middle(1)) << i;
}

TEST_F(TimelineTest, CtrlDragCopiesAndDeleteRemoves) {
    const std::string opacity = "layer.stars.render.opacity";
    const glm::vec2 from = window.at("keyframe " + opacity + " 120"),
                    to = window.at("keyframe camera.position 240");
    window.hold(true, false, false);
    window.drag(from, {to.x - from.x, 0});
    window.hold(false, false, false);
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), opacity, 120));
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), opacity, 240));
    window.tap(key_code::del);
    EXPECT_FALSE(has_keyframe_at(window.document.scene(), opacity, 240)) << "the copy was selected";
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), opacity, 120));
}

TEST_F(TimelineTest, ABoxSelectsAndMovesTogether) {
    const glm::vec2 camera = window.at("keyframe camera.position 90");
    const glm::vec2 opacity = window.at("keyframe layer.stars.render.opacity 120");
    window.drag({camera.x - 20, camera.y - 8},
                glm::vec2(opacity.x + 20, opacity.y + 8) - glm::vec2(camera.x - 20, camera.y - 8));
    window.tap(key_code::del);
    const Scene& scene = window.document.scene();
    EXPECT_FALSE(has_keyframe_at(scene, "camera.position", 90));
    EXPECT_FALSE(has_keyframe_at(scene, "layer.dust.look.alpha.power", 90));
    EXPECT_FALSE(has_keyframe_at(scene, "layer.stars.render.opacity", 120));
    EXPECT_TRUE(has_keyframe_at(scene, "camera.position", 240));
}

TEST_F(TimelineTest, TheMenuOfAKeyframeChangesItsInterpolation) {
    window.click(window.at("keyframe layer.stars.render.opacity 24"), 1);
    window.click("keyframe menu/Step");
    const Track* track = find_track(window.document.scene(), "layer.stars.render.opacity");
    ASSERT_NE(track, nullptr);
    EXPECT_EQ(track->keyframes[0].interpolation, Interpolation::step);
    EXPECT_EQ(track->keyframes[1].interpolation, Interpolation::linear);
}

TEST_F(TimelineTest, TheGraphDragsAValue) {
    window.click("graph");
    const std::string power = "layer.dust.look.alpha.power";
    window.click("track " + power);
    const glm::vec2 middle = window.at("graph " + power + " 90 0"),
                    low = window.at("graph " + power + " 1 0");
    // Half way down from 2.5 to 1.0.
    window.drag(middle, {0, (low.y - middle.y) * 0.5f});
    EXPECT_NEAR(find_track(window.document.scene(), power)->keyframes[1].value[0], 1.75, 0.02);
    window.tap('Z', true);
    EXPECT_EQ(find_track(window.document.scene(), power)->keyframes[1].value[0], 2.5);
}

// The timeline's first row by mouse and keys: frames, rate, how they are played.

struct TimelineHeader : testing::Test {
    TestWindow window{example_document()};
    void type_into(const std::string& name, const std::string& text, bool twice) {
        if (twice)
            window.double_click(window.at(name));
        else
            window.click(name);
        window.tap('A', true);
        window.type(text);
        window.tap(key_code::enter);
    }
};

TEST_F(TimelineHeader, FramesAreTyped) {
    type_into("range", "1-48", false);
    EXPECT_EQ(window.document.scene().output.frames, "1-48");
    type_into("range", "1-", false);
    EXPECT_EQ(window.document.scene().output.frames, "1-48") << "nonsense changes nothing";
    window.tap('Z', true);
    EXPECT_EQ(window.document.scene().output.frames, "1-240");
}

TEST_F(TimelineHeader, TheRateIsTyped) {
    type_into("fps", "30", true);
    EXPECT_EQ(window.document.scene().output.fps, 30.0);
    window.tap('Z', true);
    EXPECT_EQ(window.document.scene().output.fps, 24.0);
}

TEST_F(TimelineHeader, WhatComesAfterTheLastFrameIsChosen) {
    window.click("playing/Loop");
    EXPECT_EQ(window.view.play_mode, PlayMode::ping_pong);
    window.frame(2);
    window.click("playing/Ping-pong");
    EXPECT_EQ(window.view.play_mode, PlayMode::once);
    window.frame(2);
    window.click("playing/Once");
    EXPECT_EQ(window.view.play_mode, PlayMode::loop);
    window.click("playing/Every frame");
    EXPECT_TRUE(window.view.every_frame);
    window.click("playing/Rendered");
    EXPECT_TRUE(window.view.show_rendered);
}

TEST_F(TimelineHeader, InAndOutPointsAreSetByKeysAndDragged) {
    window.view.frame = 40;
    window.tap('I');
    window.view.frame = 80;
    window.tap('O');
    EXPECT_EQ(window.view.play_first, 40.0);
    EXPECT_EQ(window.view.play_last, 80.0);
    const float per_frame =
        (window.at("keyframe camera.position 240").x - window.at("keyframe camera.position 90").x) / 150.0f;
    window.drag(window.at("out point"), {60 * per_frame, 0});
    EXPECT_NEAR(*window.view.play_last, 140.0, 1.0);
    window.drag(window.at("in point"), {500 * per_frame, 0});
    EXPECT_EQ(window.view.play_first, window.view.play_last) << "it stays before the out point";
    EXPECT_EQ(window.view.frame, 80.0) << "the playhead stays";
    window.tap('I', false, true);
    EXPECT_FALSE(window.view.play_first || window.view.play_last);
}

TEST_F(TimelineHeader, TheRateThatIsReachedIsShown) {
    window.hover({-100, -100});
    const auto still = window.picture(Style::schematic).pixels;
    window.status.played_fps = 11.5;
    window.frame(2);
    EXPECT_FALSE(window.picture(Style::schematic).pixels == still);
}

// The graph by mouse: handles of Bezier keyframes, their menu, channels, zoom and pan.

struct GraphTest : testing::Test {
    const std::string key = "layer.dust.look.alpha.power";  // 1.0 at 1, 2.5 at 90, 1.2 at 180
    TestWindow window{example_document()};
    GraphTest() {
        window.view.timeline_height = 320;
        window.frame(2);
        window.click("graph");
        window.click("track " + key);
    }
    void make_bezier() {
        window.document.edit("Bezier", [&](Scene& scene) {
            for (const double frame : {1.0, 90.0, 180.0})
                set_interpolation(scene, key, frame, Interpolation::bezier);
        });
        window.click("graph " + key + " 90 0");
    }
    const Keyframe<std::vector<double>>& keyframe(std::size_t i) {
        return find_track(window.document.scene(), key)->keyframes[i];
    }
    glm::vec2 point(const std::string& name) { return window.at("graph " + name); }
    glm::vec2 handle(const std::string& side) { return window.at("handle " + key + " 90 0 " + side); }
    void open_menu() { window.click(point(key + " 90 0"), 1); }
    void choose_in_menu(const std::string& item) {
        open_menu();
        window.click("keyframe menu/" + item);
    }
};

TEST_F(GraphTest, TheMenuMakesBezierKeyframesAndTheirHandles) {
    choose_in_menu("Bezier");
    EXPECT_EQ(keyframe(1).interpolation, Interpolation::bezier);
    choose_in_menu("Flat handles");
    EXPECT_EQ(keyframe(1).out.kind, HandleKind::flat);
    choose_in_menu("Break handles");
    EXPECT_TRUE(keyframe(1).broken);
    choose_in_menu("Break handles");
    EXPECT_FALSE(keyframe(1).broken);
    choose_in_menu("Auto handles");
    EXPECT_EQ(keyframe(1).out.kind, HandleKind::automatic);
}

TEST_F(GraphTest, TheMenuEases) {
    choose_in_menu("Ease out");
    EXPECT_EQ(keyframe(1).interpolation, Interpolation::bezier);
    EXPECT_EQ(keyframe(1).out.kind, HandleKind::flat);
    EXPECT_EQ(keyframe(1).in.kind, HandleKind::automatic);
    choose_in_menu("Ease in and out");
    EXPECT_EQ(keyframe(0).interpolation, Interpolation::bezier);
    EXPECT_EQ(keyframe(1).in.kind, HandleKind::flat);
    window.document.undo();
    window.document.undo();
    EXPECT_NE(keyframe(1).interpolation, Interpolation::bezier);
}

TEST_F(GraphTest, TheMenuTicksWhatIsSet) {
    make_bezier();
    const auto tick = [&](const char* item) {
        open_menu();
        window.hover({-100, -100});
        const glm::vec2 at = window.at(std::string("keyframe menu/") + item);
        const Picture8 seen = cropped(window.picture(Style::schematic), {int(at.x), int(at.y) - 8, 170, 16});
        window.tap(key_code::escape);
        return seen.pixels;
    };
    const auto bezier = tick("Bezier"), step = tick("Step");
    window.document.edit("Step",
                         [&](Scene& scene) { set_interpolation(scene, key, 90, Interpolation::step); });
    EXPECT_FALSE(tick("Bezier") == bezier);
    EXPECT_FALSE(tick("Step") == step);
}

TEST_F(GraphTest, HandlesAreDraggedTogetherInOneStep) {
    make_bezier();
    EXPECT_NEAR(handle("out").x - point(key + " 90 0").x,
                (point(key + " 180 0").x - point(key + " 90 0").x) / 3.0f, 1.0f);
    const float up = point(key + " 1 0").y - point(key + " 90 0").y;  // 1.5 of the values
    window.drag(handle("out"), {0.0f, up / 3.0f});
    EXPECT_NEAR(keyframe(1).out.value[0], -0.5, 0.03);
    EXPECT_NEAR(keyframe(1).out.frames, 30.0, 0.5);
    EXPECT_NEAR(keyframe(1).in.value[0], 0.5 * 89.0 / 90.0, 0.03) << "the other one turns with it";
    window.tap('Z', true);
    EXPECT_EQ(keyframe(1).out.kind, HandleKind::automatic) << "one drag is one step";
}

TEST_F(GraphTest, AltBreaksAHandle) {
    make_bezier();
    window.hold(false, false, true);
    window.drag(handle("out"), {10.0f, 30.0f});
    window.hold(false, false, false);
    EXPECT_TRUE(keyframe(1).broken);
    EXPECT_EQ(keyframe(1).in.kind, HandleKind::automatic);
    EXPECT_EQ(keyframe(1).out.kind, HandleKind::free);
}

TEST_F(GraphTest, EscapeTakesADragBack) {
    make_bezier();
    const Scene before = window.document.scene();
    for (const glm::vec2 from : {handle("out"), point(key + " 90 0")}) {
        window.hover(from);
        window.press();
        window.frame(2);
        window.hover(from + glm::vec2(0, 40));
        EXPECT_FALSE(window.document.scene() == before);
        window.tap(key_code::escape);
        window.hover(from + glm::vec2(0, 60));
        window.release();
        window.frame(2);
        EXPECT_TRUE(window.document.scene() == before);
    }
}

TEST_F(GraphTest, TheWheelZoomsValuesAndTheMiddleButtonMovesThePlot) {
    const auto apart = [&] { return point(key + " 1 0") - point(key + " 90 0"); };
    const glm::vec2 before = apart(), middle = window.at("graph area");
    window.hover(middle);
    window.wheel(1);
    window.frame(2);
    EXPECT_NEAR(apart().y, 1.25f * before.y, 1.0f);
    EXPECT_NEAR(apart().x, before.x, 0.5f);
    window.hold(true, false, false);
    window.wheel(1);
    window.hold(false, false, false);
    window.frame(2);
    EXPECT_NEAR(apart().x, 1.25f * before.x, 1.0f);
    const glm::vec2 at = point(key + " 90 0");
    window.drag(middle, {-30, 20}, 2);
    window.frame(2);
    EXPECT_NEAR(point(key + " 90 0").x, at.x - 30.0f, 1.0f);
    EXPECT_NEAR(point(key + " 90 0").y, at.y + 20.0f, 1.0f);
    window.double_click(window.at("graph area"));
    EXPECT_NEAR(apart().y, before.y, 0.5f);
    EXPECT_NEAR(apart().x, before.x, 0.5f);
}

TEST_F(GraphTest, ChannelsAreHiddenAndShownOneByOne) {
    window.click("track camera.position");
    const auto seen = [&](int channel) {
        return window.has("graph camera.position 90 " + std::to_string(channel));
    };
    EXPECT_TRUE(seen(0) && seen(1) && seen(2));
    window.click("channel camera.position 1");
    EXPECT_TRUE(seen(0) && !seen(1) && seen(2));
    window.hold(false, true, false);
    window.click("channel camera.position 2");
    EXPECT_TRUE(!seen(0) && !seen(1) && seen(2)) << "Shift: it alone";
    window.click("channel camera.position 2");
    window.hold(false, false, false);
    window.frame(2);
    EXPECT_TRUE(seen(0) && seen(1) && seen(2)) << "and all again";
}

}  // namespace
}  // namespace astrosplat
