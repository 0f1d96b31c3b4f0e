// The timeline by mouse: playhead, keyframes, their menu and the graph.
#include <gtest/gtest.h>

#include "edit/keyframes.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"

namespace astrosplat {
namespace {

TEST(Timeline, ThePlayheadIsDragged) {
    TestWindow window(example_document());
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

TEST(Timeline, AFrameIsTyped) {
    TestWindow window(example_document());
    window.double_click(window.at("frame"));
    window.tap('A', true);
    window.type("137");
    window.tap(key_code::enter);
    EXPECT_EQ(window.view.frame, 137.0);
}

TEST(Timeline, AStillIsAsLongAsTheFilmThatItMayBecome) {
    TestWindow window(Document::untitled("astrosplat = 1\n[output]\nframes = \"1\"\n", "/scene.toml"));
    window.view.view = ViewKind::free;
    const glm::vec2 ruler = window.at("ruler");
    window.drag(ruler, {2000, 0});
    EXPECT_EQ(window.view.frame, 240.0);
    window.tap('K');
    window.frame(2);
    EXPECT_EQ(window.document.scene().output.frames, "1-240");
    window.drag(ruler, {-2000, 0});
    EXPECT_EQ(window.view.frame, 1.0);
}

TEST(Timeline, ThePlayheadComesAlongWhereUndoTakesItsFrameAway) {
    TestWindow window(example_document());
    window.document.edit("Longer", [](Scene& scene) { scene.output.frames = "1-400"; });
    window.frame(2);
    window.view.frame = 390.0;
    window.frame(2);
    window.tap('Z', true);
    window.frame(2);
    EXPECT_EQ(window.view.frame, 240.0);
}

TEST(Timeline, AKeyframeMovesWithTheMouse) {
    TestWindow window(example_document());
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

TEST(Timeline, KeyframesOfTheFirstAndTheLastRowMoveToo) {
    TestWindow window(example_document());
    const auto at = [&](const char* key) { return window.at(std::string("keyframe ") + key); };
    const float per_frame = (at("camera.position 240").x - at("camera.position 90").x) / 150.0f;
    window.drag(at("camera.position 90"), {20 * per_frame, 0});
    window.drag(at("layer.stars.render.opacity 24"), {20 * per_frame, 0});
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), "camera.position", 110));
    EXPECT_TRUE(has_keyframe_at(window.document.scene(), "layer.stars.render.opacity", 44));
}

/// The same scene looks the same, whether it was opened so or edited while it was shown.
TEST(Timeline, ShowsTheSceneAsItIsNow) {
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

TEST(Timeline, EveryInterpolationHasAMarkOfItsOwn) {
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
        const Picture8 mark = cropped(window.picture(Style::schematic), static_cast<int>(place.x) - 4,
                                      static_cast<int>(place.y) - 4, 9, 9);
        for (const auto& other : marks) EXPECT_FALSE(mark.pixels == other) << interpolation;
        marks.push_back(mark.pixels);
    }
    const auto middle = [&](std::size_t i) { return marks[i][4 * 9 + 4]; };
    EXPECT_FALSE(middle(1) == middle(0));
    for (const std::size_t i : {2u, 3u}) EXPECT_TRUE(middle(i) == middle(1)) << i;
}

TEST(Timeline, CtrlDragCopiesAndDeleteRemoves) {
    TestWindow window(example_document());
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

TEST(Timeline, ABoxSelectsAndMovesTogether) {
    TestWindow window(example_document());
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

TEST(Timeline, TheMenuOfAKeyframeChangesItsInterpolation) {
    TestWindow window(example_document());
    window.click(window.at("keyframe layer.stars.render.opacity 24"), 1);
    window.frame();
    window.click("keyframe menu/Step");
    const Track* track = find_track(window.document.scene(), "layer.stars.render.opacity");
    ASSERT_NE(track, nullptr);
    EXPECT_EQ(track->keyframes[0].interpolation, Interpolation::step);
    EXPECT_EQ(track->keyframes[1].interpolation, Interpolation::linear);
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
    EXPECT_NEAR(find_track(window.document.scene(), power)->keyframes[1].value[0], 1.75, 0.02);
    window.tap('Z', true);
    EXPECT_EQ(find_track(window.document.scene(), power)->keyframes[1].value[0], 2.5);
}

}  // namespace
}  // namespace astrosplat
