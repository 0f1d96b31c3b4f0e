// Handles of a thing in the world, seen along -z at 100 px a scene unit: what lies under the mouse, and what
// dragging it does to the layer, a crop, the camera's target.
#include "edit/handles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/rotation.h"
#include "edit/placement.h"
#include "edit/rounding.h"
#include "unit/edit/scenes.h"

namespace astrosplat {
namespace {

constexpr double size = 800.0;  // px; the origin is in the middle

struct HandlesTest : testing::Test {
    Camera camera;
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");
    ViewState view;
    HandlesTest() {
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position = glm::dvec3(0.0, 0.0, 50.0);
        params.height = 8.0;
        camera = make_camera(params, size, size, {});
        scene.layers[0].transform = {};
    }
    /// px of a place in the world.
    glm::dvec2 px(const glm::dvec3& place) const { return glm::dvec2(*project_point(camera, place)); }
    Grip grip(HandleTool tool, const glm::dvec3& place) const {
        return grip_at(camera, {}, tool, px(place), {});
    }
    static HandleDrag drag(Grip grip, const glm::dvec2& from, const glm::dvec2& to) {
        return {grip, from, to};
    }
    HandleDrag drag(Grip grip, const glm::dvec3& from, const glm::dvec3& to) const {
        return {grip, px(from), px(to)};
    }
    /// The value of the parameter that a drag changes.
    std::vector<double> dragged(const std::string& key, const HandleDrag& by) {
        const NewValue value = dragged_value(scene, view, camera, by);
        EXPECT_EQ(value.key, key);
        if (!value.value.list()) return {value.value.number()};
        std::vector<double> numbers;
        for (const Value& number : *value.value.list()) numbers.push_back(number.number());
        return numbers;
    }
    std::string layer() const { return "layer." + scene.layers[0].name; }
};

using Values = std::vector<double>;

TEST_F(HandlesTest, TheNearestOneLiesUnderTheMouse) {
    EXPECT_EQ(grip(HandleTool::move, {0.0, 0.0, 0.0}), Grip::middle);
    EXPECT_EQ(grip(HandleTool::move, {0.6, 0.05, 0.0}), Grip::x);
    EXPECT_EQ(grip(HandleTool::move, {0.05, 0.6, 0.0}), Grip::y);
    EXPECT_EQ(grip(HandleTool::move, {0.6, 0.2, 0.0}), Grip::none);
    EXPECT_EQ(grip(HandleTool::move, {1.1, 0.0, 0.0}), Grip::none) << "beyond its end";
    EXPECT_EQ(grip(HandleTool::rotate, {0.6364, 0.6364, 0.0}), Grip::z);
    EXPECT_EQ(grip(HandleTool::none, {0.0, 0.0, 0.0}), Grip::none);
    Handled whole;
    whole.uniform = true;
    EXPECT_EQ(grip_at(camera, whole, HandleTool::scale, px({0.0, 0.9, 0.0}), {}), Grip::middle);
    EXPECT_EQ(grip_at(camera, whole, HandleTool::scale, px({0.5, 0.0, 0.0}), {}), Grip::none);
}

TEST_F(HandlesTest, AnAxisHoldsTheMoveToItself) {
    const glm::dvec3 by = moved_by(camera, {}, drag(Grip::x, {0.5, 0.0, 0.0}, {1.75, 0.4, 0.0}));
    EXPECT_LT(glm::length(by - glm::dvec3(1.25, 0.0, 0.0)), 1e-6);
    const glm::dvec3 free = moved_by(camera, {}, drag(Grip::middle, {0.0, 0.0, 0.0}, {1.0, -2.0, 0.0}));
    EXPECT_LT(glm::length(free - glm::dvec3(1.0, -2.0, 0.0)), 1e-6);
}

TEST_F(HandlesTest, ARingTurnsAsFarAsTheMouseGoesAround) {
    const glm::dmat3 turn = turned_by(camera, {}, drag(Grip::z, {0.9, 0.0, 0.0}, {0.0, 0.9, 0.0}));
    EXPECT_LT(glm::length(turn * glm::dvec3(1.0, 0.0, 0.0) - glm::dvec3(0.0, 1.0, 0.0)), 1e-6);
    const glm::dmat3 middle = turned_by(camera, {}, drag(Grip::middle, {0.9, 0.0, 0.0}, {0.0, 0.9, 0.0}));
    EXPECT_LT(glm::length(middle[0] - turn[0]), 1e-6);
}

/// A ring seen from its side: its nearer half follows the mouse.
TEST_F(HandlesTest, ARingSeenFromTheSideFollowsTheMouse) {
    const glm::dmat3 turn = turned_by(camera, {}, drag(Grip::y, {0.0, 0.0, 0.0}, {0.9, 0.0, 0.0}));
    const glm::dvec3 nearest = turn * glm::dvec3(0.0, 0.0, 1.0);
    EXPECT_NEAR(nearest.x, std::sin(1.0), 1e-6);
    EXPECT_NEAR(nearest.z, std::cos(1.0), 1e-6);
}

TEST_F(HandlesTest, AnAxisScalesItselfAndTheMiddleAll) {
    const glm::dvec3 one = scaled_by(camera, {}, drag(Grip::y, {0.0, 0.5, 0.0}, {0.3, 1.5, 0.0}));
    EXPECT_LT(glm::length(one - glm::dvec3(1.0, 3.0, 1.0)), 1e-6);
    const glm::dvec3 all = scaled_by(camera, {}, drag(Grip::middle, {0.0, 0.9, 0.0}, {1.8, 0.0, 0.0}));
    EXPECT_LT(glm::length(all - glm::dvec3(2.0)), 1e-6);
    EXPECT_GT(scaled_by(camera, {}, drag(Grip::y, {0.0, 0.5, 0.0}, {0.0, -3.0, 0.0})).y, 0.0);
}

TEST_F(HandlesTest, ALayersPlacementIsDragged) {
    scene.layers[0].transform.translate = {0.123456, 0.0, 0.0};
    view.tool = HandleTool::move;
    EXPECT_EQ(dragged(layer() + ".transform.translate", drag(Grip::y, {0.1, 0.5, 0.0}, {0.1, 1.004, 0.0})),
              (Values{0.123456, 0.5, 0.0}))
        << "rounded to a pixel where it changes";
    view.tool = HandleTool::rotate;
    scene.layers[0].transform = {{}, {0.0, 0.0, 10.0}, 1.0};
    EXPECT_EQ(dragged(layer() + ".transform.rotate", drag(Grip::z, {0.9, 0.0, 0.0}, {0.0, 0.9, 0.0})),
              (Values{0.0, 0.0, 100.0}));
    view.tool = HandleTool::scale;
    scene.layers[0].transform.scale = 1.5;
    EXPECT_EQ(dragged(layer() + ".transform.scale", drag(Grip::middle, {0.0, 0.9, 0.0}, {0.0, 1.8, 0.0})),
              (Values{3.0}));
}

/// The layer is turned by 90 degrees about z and twice as large: its x points upwards.
TEST_F(HandlesTest, ACropIsDraggedInTheLayersOwnSpace) {
    scene.layers[0].transform = {{1.0, 0.0, 0.0}, {0.0, 0.0, 90.0}, 2.0};
    scene.layers[0].look.crop.resize(1);
    scene.layers[0].look.crop[0].center = {0.5f, 0.0f, 0.0f};
    view.handle_target = HandleTarget::crop;
    view.tool = HandleTool::move;
    EXPECT_LT(glm::length(handled_in(scene, view)->origin - glm::dvec3(1.0, 1.0, 0.0)), 1e-9);
    EXPECT_EQ(dragged(layer() + ".look.crop.0.center", drag(Grip::x, {1.0, 1.5, 0.0}, {1.0, 2.5, 0.0})),
              (Values{1.0, 0.0, 0.0}));
    EXPECT_EQ(dragged(layer() + ".look.crop.0.center", drag(Grip::x, {1.0, 1.5, 0.0}, {1.0, 2.506, 0.0})),
              (Values{1.003, 0.0, 0.0}))
        << "rounded to a pixel, which is half as large in the layer";
    view.tool = HandleTool::scale;
    EXPECT_EQ(dragged(layer() + ".look.crop.0.size", drag(Grip::x, {1.0, 1.5, 0.0}, {1.0, 2.0, 0.0})),
              (Values{2.0, 1.0, 1.0}));
    view.tool = HandleTool::rotate;
    EXPECT_EQ(dragged(layer() + ".look.crop.0.rotate", drag(Grip::z, {1.9, 1.0, 0.0}, {1.0, 1.9, 0.0})),
              (Values{0.0, 0.0, 90.0}));
    scene.layers[0].look.crop[0].shape = Crop::Shape::sphere;
    EXPECT_FALSE(handled_in(scene, view)) << "a sphere has no direction";
    view.tool = HandleTool::scale;
    EXPECT_EQ(dragged(layer() + ".look.crop.0.radius", drag(Grip::middle, {1.0, 1.9, 0.0}, {1.0, 2.8, 0.0})),
              (Values{2.0}));
}

TEST_F(HandlesTest, TheCamerasTargetIsDragged) {
    scene.camera.position = glm::dvec3(0.0, 0.0, 20.0);
    scene.camera.target = glm::dvec3(0.0);
    view.handle_target = HandleTarget::camera_target;
    view.tool = HandleTool::move;
    EXPECT_EQ(dragged("camera.target", drag(Grip::x, {0.5, 0.0, 0.0}, {2.0, 0.0, 0.0})),
              (Values{1.5, 0.0, 0.0}));
    view.tool = HandleTool::scale;
    EXPECT_FALSE(handled_in(scene, view));
    view.tool = HandleTool::move;
    scene.camera.rotation = glm::dvec4(0.0, 0.0, 0.0, 1.0);
    EXPECT_FALSE(handled_in(scene, view)) << "a camera turned by a rotation looks at no target";
}

TEST(Rounding, LeavesTheDigitsOfTheStepAndNoSignOfZero) {
    EXPECT_EQ(rounded_to_step(0.123456, 0.005), 0.123);
    EXPECT_EQ(rounded_to_step(1234.5, 20.0), 1230.0);
    EXPECT_EQ(rounded_to_step(1.5, 0.0), 1.5);
    EXPECT_FALSE(std::signbit(rounded_to_step(-0.001, 0.1)));
}

TEST_F(HandlesTest, CropsAreOutlinedWhereTheyAre) {
    LayerParams layer = scene.layers[0];
    layer.transform = {{0.0, 5.0, 0.0}, {}, 2.0};
    layer.look.crop.resize(2);
    layer.look.crop[1].shape = Crop::Shape::sphere;
    layer.look.crop[1].radius = 3.0f;
    EXPECT_EQ(crop_outline(layer, 0).size(), 12u);
    for (const auto& ring : crop_outline(layer, 1))
        for (const glm::dvec3& p : ring) EXPECT_NEAR(glm::length(p - glm::dvec3(0.0, 5.0, 0.0)), 6.0, 1e-9);
}

}  // namespace
}  // namespace astrosplat
