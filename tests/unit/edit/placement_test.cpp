// Where layers are in the world and in a frame, and the handles that move them.
#include "edit/placement.h"
#include "core/rotation.h"
#include "edit/edits.h"
#include "support/test.h"
#include "unit/edit/scenes.h"

namespace astrosplat {
namespace {

// Where layers are in the world and back, angles of rotations, boxes, grid and axes.

constexpr double small = 1e-9;

double difference(const glm::dmat3& a, const glm::dmat3& b) {
    double most = 0.0;
    for (int i = 0; i < 3; ++i) most = std::max(most, glm::length(a[i] - b[i]));
    return most;
}

TEST(Placement, ScalesThenTurnsThenMoves) {
    const LayerPlacement placement = placement_of({{10.0, 0.0, 0.0}, {0.0, 0.0, 90.0}, 2.0});
    expect_near(to_world(placement, {1.0, 0.0, 3.0}), {10.0, 2.0, 6.0});
    expect_near(to_layer(placement, {10.0, 2.0, 6.0}), {1.0, 0.0, 3.0});
}

TEST(Placement, AnglesSayTheirRotation) {
    for (const glm::dvec3 degrees : {glm::dvec3(10, 20, 30), glm::dvec3(-170, 80, 5), glm::dvec3(0, 0, 179)})
        expect_near(degrees_of(rotation_from_degrees(degrees), degrees), degrees);
}

/// The other triple of angles that says the same, whole turns, and a pole, where two angles turn
/// about one line.
TEST(Placement, OfAllAnglesTheNearestOnesAreTaken) {
    for (const glm::dvec3 degrees : {glm::dvec3(190, 160, 210), glm::dvec3(730, 20, -350),
                                     glm::dvec3(40, 90, 25), glm::dvec3(40, -90, 25)}) {
        const glm::dmat3 rotation = rotation_from_degrees(degrees);
        const glm::dvec3 found = degrees_of(rotation, degrees + glm::dvec3(0.1, -0.1, 0.1));
        EXPECT_LT(difference(rotation_from_degrees(found), rotation), 1e-7);
        EXPECT_LT(glm::length(found - degrees), 1.0);
    }
}

/// At a pole x and z turn about one line: x stays as it was.
TEST(Placement, AtAPoleTheAnglesStay) {
    const glm::dmat3 turned(0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0);  // by 90 degrees about y
    expect_near(degrees_of(turned, {40.0, 90.0, 40.0}), {40.0, 90.0, 40.0});
    expect_near(degrees_of(turned, {0.0, 90.0, 0.0}), {0.0, 90.0, 0.0});
}

TEST(Placement, RotationsFollowTheRightHand) {
    expect_near(rotation_about({0.0, 0.0, 1.0}, real::radians(90.0)) * glm::dvec3(1.0, 0.0, 0.0),
                {0.0, 1.0, 0.0});
    EXPECT_LT(
        difference(rotation_about({0.0, 1.0, 0.0}, real::radians(25.0)), rotation_from_degrees({0, 25, 0})),
        small);
}

TEST(SceneMarks, ABoxHasTwelveEdgesPlacedAsItsLayer) {
    const Bounds box{{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
    const std::vector<MarkLine> edges = box_edges(box, {{5.0, 0.0, 0.0}, {0.0, 0.0, 90.0}, 2.0});
    ASSERT_EQ(edges.size(), 12u);
    double length = 0.0;
    for (const MarkLine& edge : edges) length += glm::length(edge.to - edge.from);
    EXPECT_NEAR(length, 2.0 * 4.0 * (1.0 + 2.0 + 3.0), small);
    expect_near(edges[0].from, {5.0, 0.0, 0.0});
    expect_near(edges[0].to, {5.0, 2.0, 0.0});
    EXPECT_TRUE(box_edges({}, {}).empty());
}

TEST(SceneMarks, TheGridHasRoundStepsAndHoldsTheBox) {
    const Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
    const Grid grid = grid_around(box, ViewKind::free);
    EXPECT_EQ(grid.spacing, 1.0);
    Bounds held;
    for (const MarkLine& line : grid.lines) {
        EXPECT_EQ(line.from.y, 0.0);
        EXPECT_EQ(line.to.y, 0.0);
        held.add(line.from);
        held.add(line.to);
    }
    EXPECT_TRUE(held.lo.x <= box.lo.x && held.hi.x >= box.hi.x && held.lo.z <= box.lo.z &&
                held.hi.z >= box.hi.z);
    EXPECT_EQ(grid_around({{0.0, 0.0, 0.0}, {0.02, 0.0, 0.0}}, ViewKind::free).spacing, 0.002);
    EXPECT_EQ(grid_around({{0.0, 0.0, 0.0}, {45.0, 1.0, 0.0}}, ViewKind::free).spacing, 5.0);
}

// 160 px of .01 units and 25 light years each are 40 ly long.
TEST(SceneMarks, TheScaleBarIsTheLongestRoundOneThatFits) {
    const auto expect_bar = [](const ScaleBar& bar, const char* text, double length_px) {
        EXPECT_EQ(bar.text, text);
        EXPECT_NEAR(bar.length_px, length_px, 1e-9);
    };
    expect_bar(scale_bar(0.01, 25.0, 160.0), "20 ly", 80.0);
    expect_bar(scale_bar(0.01, 31.25, 160.0), "50 ly", 160.0);
    expect_bar(scale_bar(0.01, 31.2, 160.0), "20 ly", 20.0 / 0.312);
    expect_bar(scale_bar(0.01, 1e4, 160.0), "10 kly", 100.0);
    expect_bar(scale_bar(0.01, 0.0, 160.0), "1 scene unit", 100.0);
    expect_bar(scale_bar(1e-5, 0.0, 160.0), "0.001 scene units", 100.0);
}

TEST(SceneMarks, LengthsAreSaidInLightYearsAsWell) {
    EXPECT_EQ(length_text(14.1519, 0.0), "14.15 scene units");
    EXPECT_EQ(length_text(14.1519, 2520.0), "14.15 scene units, 35.7 kly");
}

TEST(SceneMarks, TheGridFacesTheView) {
    const Bounds box{{-4.0, 2.0, -3.0}, {6.0, 4.0, 5.0}};
    const auto flat_in = [&](ViewKind view, int axis, double place) {
        for (const MarkLine& line : grid_around(box, view).lines)
            if (line.from[axis] != place || line.to[axis] != place) return false;
        return true;
    };
    EXPECT_TRUE(flat_in(ViewKind::front, 2, 0.0));
    EXPECT_TRUE(flat_in(ViewKind::side, 0, 0.0));
    EXPECT_TRUE(flat_in(ViewKind::top, 1, 2.0)) << "the side of the box that is nearest to the origin";
}

TEST(SceneMarks, AxesBeginAtTheOrigin) {
    const auto axes = axis_lines({{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}});
    expect_near(axes[0].from, {0.0, 0.0, 0.0});
    expect_near(axes[0].to, {5.0, 0.0, 0.0});
    expect_near(axes[1].to, {0.0, 5.0, 0.0});
    expect_near(axes[2].to, {0.0, 0.0, 5.0});
}

// Where points and lines of the world lie in a frame, and back: closed forms of a camera along -z.

constexpr double width = 400.0, height = 200.0;  // px

/// At z = 10, seeing 4 scene units of height at the origin.
Camera camera_of(Projection projection) {
    CameraParams params;
    params.projection = projection;
    params.position = glm::dvec3(0.0, 0.0, 10.0);
    params.fov = 22.619864948040426;  // 2 atan(2 / 10)
    params.height = 4.0;
    return make_camera(params, width, height, {});
}

constexpr Projection projections[] = {Projection::perspective, Projection::orthographic};

TEST(ProjectPoint, APlaneOfFourUnitsFillsTheFramesHeight) {
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const auto at = project_point(camera, {1.0, 2.0, 0.0});
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->x, 250.0f, 1e-4f);
        EXPECT_NEAR(at->y, 0.0f, 1e-4f);
        EXPECT_NEAR(units_per_px(camera, {1.0, 2.0, 0.0}), 4.0 / height, 1e-12);
        EXPECT_NEAR(view_depth(camera, {1.0, 2.0, 3.0}), 7.0, 1e-12);
    }
}

TEST(ProjectPoint, TheRayThroughItMeetsThePoint) {
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const glm::dvec3 point(1.5, -0.7, 3.0);
        const ViewRay ray = ray_through(camera, glm::dvec2(*project_point(camera, point)));
        EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-12);
        EXPECT_LT(glm::length(glm::cross(point - ray.origin, ray.direction)), 1e-5);
    }
}

TEST(ProjectPoint, OnScreenItIsScaledAndMoved) {
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const Camera shown = camera_on_screen(camera, {30.0, 40.0}, 0.5);
        const auto at = project_point(shown, {1.0, 2.0, 0.0});
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->x, 30.0f + 125.0f, 1e-4f);
        EXPECT_NEAR(at->y, 40.0f, 1e-4f);
    }
}

TEST(ProjectLine, BehindTheEyeItIsCut) {
    const Camera camera = camera_of(Projection::perspective);
    EXPECT_FALSE(project_point(camera, {0.0, 0.0, 11.0}));
    const auto parts = project_line(camera, {{-1.0, 0.0, 0.0}, {0.0, 0.0, 20.0}, {1.0, 0.0, 0.0}});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].size(), 2u);
    EXPECT_NEAR(parts[0][0].x, 150.0f, 1e-4f);
    EXPECT_NEAR(parts[1][1].x, 250.0f, 1e-4f);
}

TEST(ProjectLine, ParallelRaysSeeAlsoWhatLiesBehindTheirPlane) {
    const Camera camera = camera_of(Projection::orthographic);
    const auto parts = project_line(camera, {{-1.0, 0.0, 0.0}, {0.0, 0.0, 20.0}, {1.0, 0.0, 0.0}});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].size(), 3u);
}

// Handles of a thing in the world, seen along -z at 100 px a scene unit: what lies under the mouse, and what
// dragging it does to the layer, a crop, the camera's target.

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
