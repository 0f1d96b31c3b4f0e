// The graph by mouse: handles of Bezier keyframes, their menu, channels, zoom and pan.
#include <gtest/gtest.h>

#include "edit/keyframes.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"

namespace astrosplat {
namespace {

struct GraphTest : testing::Test {
    const std::string key = "layer.dust.look.alpha.power";  // 1.0 at 1, 2.5 at 90, 1.2 at 180
    TestWindow window{example_document()};
    GraphTest() {
        window.view.timeline_height = 320;
        window.frame(2);
        window.click("graph");
        window.click("track " + key);
        window.frame(2);
    }
    void make_bezier() {
        window.document.edit("Bezier", [&](Scene& scene) {
            for (const double frame : {1.0, 90.0, 180.0})
                set_interpolation(scene, key, frame, Interpolation::bezier);
        });
        window.click("graph " + key + " 90 0");
        window.frame(2);
    }
    const Keyframe<std::vector<double>>& keyframe(std::size_t i) {
        return find_track(window.document.scene(), key)->keyframes[i];
    }
    glm::vec2 point(const std::string& name) { return window.at("graph " + name); }
    glm::vec2 handle(const std::string& side) { return window.at("handle " + key + " 90 0 " + side); }
    void open_menu() {
        window.click(point(key + " 90 0"), 1);
        window.frame(2);
    }
    void choose_in_menu(const std::string& item) {
        open_menu();
        window.click("keyframe menu/" + item);
        window.frame(3);
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

TEST_F(GraphTest, TheMenuTicksWhatIsSet) {
    make_bezier();
    const auto tick = [&](const char* item) {
        open_menu();
        window.move({-100, -100});
        window.frame(2);
        const glm::vec2 at = window.at(std::string("keyframe menu/") + item);
        const Picture8 seen = cropped(window.picture(Style::schematic), static_cast<int>(at.x),
                                      static_cast<int>(at.y) - 8, 170, 16);
        window.tap(key_code::escape);
        window.frame(2);
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
        window.move(from);
        window.frame(2);
        window.press();
        window.frame(2);
        window.move(from + glm::vec2(0, 40));
        window.frame(2);
        EXPECT_FALSE(window.document.scene() == before);
        window.tap(key_code::escape);
        window.move(from + glm::vec2(0, 60));
        window.frame(2);
        window.release();
        window.frame(2);
        EXPECT_TRUE(window.document.scene() == before);
    }
}

TEST_F(GraphTest, TheWheelZoomsValuesAndTheMiddleButtonMovesThePlot) {
    const auto apart = [&] { return point(key + " 1 0") - point(key + " 90 0"); };
    const glm::vec2 before = apart(), middle = window.at("graph area");
    window.move(middle);
    window.frame(2);
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
    window.frame(3);
    EXPECT_NEAR(apart().y, before.y, 0.5f);
    EXPECT_NEAR(apart().x, before.x, 0.5f);
}

TEST_F(GraphTest, ChannelsAreHiddenAndShownOneByOne) {
    window.click("track camera.position");
    window.frame(2);
    const auto seen = [&](int channel) {
        return window.has("graph camera.position 90 " + std::to_string(channel));
    };
    EXPECT_TRUE(seen(0) && seen(1) && seen(2));
    window.click("channel camera.position 1");
    window.frame(2);
    EXPECT_TRUE(seen(0) && !seen(1) && seen(2));
    window.hold(false, true, false);
    window.click("channel camera.position 2");
    window.frame(2);
    EXPECT_TRUE(!seen(0) && !seen(1) && seen(2)) << "Shift: it alone";
    window.click("channel camera.position 2");
    window.hold(false, false, false);
    window.frame(2);
    EXPECT_TRUE(seen(0) && seen(1) && seen(2)) << "and all again";
}

}  // namespace
}  // namespace astrosplat
