// The camera's keyframes as points in the view, by mouse.
#include <gtest/gtest.h>

#include <cmath>

#include "edit/keyframes.h"
#include "edit/placement.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"

namespace astrosplat {
namespace {

struct PathPointsTest : testing::Test {
    TestWindow window{example_document()};
    Rect area = make_layout(window.view, 1600.0f, 900.0f, 1.0f).viewport;
    Camera camera;
    PathPointsTest() {
        CameraParams params;
        params.position = glm::dvec3(0.0, 40.0, 0.01);  // from above: right is +x, down +z
        camera = make_camera(params, static_cast<double>(area.width), static_cast<double>(area.height), {});
        window.status.viewport_camera = camera;
        window.view.view = ViewKind::free;
        window.frame(2);
    }
    glm::dvec3 position(std::size_t i) {
        const std::vector<double>& v =
            find_track(window.document.scene(), "camera.position")->keyframes[i].value;
        return {v[0], v[1], v[2]};
    }
};

TEST_F(PathPointsTest, LieWhereTheCameraIsAndShowTheirFrame) {
    const glm::vec2 place = *project_point(camera, glm::dvec3(8.0, 3.0, 8.0));
    EXPECT_NEAR(window.at("path point 90").x, area.x + place.x, 0.01f);
    EXPECT_NEAR(window.at("path point 90").y, area.y + place.y, 0.01f);
    window.click("path point 90");
    EXPECT_EQ(window.view.frame, 90.0);
    EXPECT_FALSE(window.document.can_undo());
    window.view.view = ViewKind::camera;
    window.frame(2);
    EXPECT_FALSE(window.has("path point 90")) << "the camera does not see itself";
}

TEST_F(PathPointsTest, AreDraggedInThePlaneOfTheView) {
    const double unit = units_per_px(camera, position(1));
    window.drag(window.at("path point 90"), {50, -30});
    EXPECT_NEAR(position(1).x, 8.0 + 50 * unit, 0.02);
    EXPECT_NEAR(position(1).z, 8.0 - 30 * unit, 0.02);
    EXPECT_NEAR(position(1).y, 3.0, 0.02);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::none);
    window.tap('Z', true);
    EXPECT_EQ(position(1), glm::dvec3(8.0, 3.0, 8.0)) << "one drag is one step";
    EXPECT_FALSE(window.document.can_undo());
}

TEST_F(PathPointsTest, AreDraggedAlongTheViewWithShift) {
    window.hold(false, true, false);
    window.drag(window.at("path point 90"), {0, 40});
    window.hold(false, false, false);
    EXPECT_NEAR(position(1).x, 8.0, 0.02);
    EXPECT_GT(position(1).y, 4.0) << "down the screen is nearer";
}

TEST_F(PathPointsTest, EscapeTakesADragBack) {
    const glm::vec2 from = window.at("path point 90");
    window.move(from);
    window.frame(2);
    window.press();
    window.frame(2);
    window.move(from + glm::vec2(40, 0));
    window.frame(2);
    EXPECT_FALSE(position(1) == glm::dvec3(8.0, 3.0, 8.0));
    window.tap(key_code::escape);
    window.move(from + glm::vec2(80, 0));
    window.frame(2);
    window.release();
    window.frame(2);
    EXPECT_EQ(position(1), glm::dvec3(8.0, 3.0, 8.0));
    EXPECT_EQ(window.view.frame, 1.0);
}

TEST_F(PathPointsTest, HandlesBendThePath) {
    EXPECT_FALSE(window.has("path out 90"));
    window.document.edit("Bezier", [](Scene& scene) {
        for (const double frame : {1.0, 90.0})
            set_interpolation(scene, "camera.position", frame, Interpolation::bezier);
    });
    window.frame(2);
    const glm::dvec3 at = position(1);
    const auto keyframe = [&] {
        return find_track(window.document.scene(), "camera.position")->keyframes[1];
    };
    window.drag(window.at("path out 90"), {0, 60});
    EXPECT_EQ(position(1), at);
    EXPECT_EQ(keyframe().out.kind, HandleKind::free);
    EXPECT_NEAR(keyframe().out.frames, 50.0, 1e-9);
    EXPECT_EQ(keyframe().in.kind, HandleKind::free);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(keyframe().in.value[c] / keyframe().in.frames,
                    keyframe().out.value[c] / keyframe().out.frames, 1e-9)
            << "the path goes on smoothly";
    window.tap('Z', true);
    EXPECT_EQ(keyframe().out.kind, HandleKind::automatic);
}

}  // namespace
}  // namespace astrosplat
