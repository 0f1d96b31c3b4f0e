// Handles and the camera's path over the viewport.
#include "edit/edits.h"
#include "edit/placement.h"
#include "gui/panel/panel.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "support/test.h"
#include "unit/edit/scenes.h"

namespace astrosplat {
namespace {

// Handles, boxes, grid and axes over the viewport: switched, dragged, taken back.

/// Seen along -z with parallel rays; the world's origin lies in the middle of the viewport.
class ViewHandles : public testing::Test {
  protected:
    ViewHandles() {
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position = glm::dvec3(0.0, 0.0, 50.0);
        params.height = 20.0;
        area = make_layout(window.view, 1600.0f, 900.0f, 1.0f).viewport;
        window.status.viewport_camera = make_camera(params, double(area.width), double(area.height), {});
        for (LayerStatus& layer : window.status.layers) layer.box = {{-5.0, -0.5, -5.0}, {5.0, 0.5, 5.0}};
        window.frame(2);
    }
    glm::vec2 at(const glm::dvec3& place) const {
        return glm::vec2(area.x, area.y) + *project_point(*window.status.viewport_camera, place);
    }
    const LayerParams& layer() const { return window.document.scene().layers[0]; }
    int count(ImU32 wanted) {
        window.hover({5.0f, 5.0f});
        const Picture8 picture = window.picture();
        int found = 0;
        for (int y = int(area.y); y < int(area.y + area.height); ++y)
            for (int x = int(area.x); x < int(area.x + area.width); ++x) {
                const Rgba8 p = picture.at(x, y);
                const ImVec4 c = color4(wanted);
                found += std::abs(int(p.r) - int(255 * c.x)) + std::abs(int(p.g) - int(255 * c.y)) +
                             std::abs(int(p.b) - int(255 * c.z)) <
                         6;
            }
        return found;
    }
    TestWindow window{example_document()};
    Rect area;
};

TEST_F(ViewHandles, WERChooseTheToolAndAgainNone) {
    for (const auto& [key, tool] :
         {std::pair{'W', HandleTool::move}, {'E', HandleTool::rotate}, {'R', HandleTool::scale}}) {
        window.tap(key);
        EXPECT_EQ(window.view.tool, tool);
        window.tap(key);
        EXPECT_EQ(window.view.tool, HandleTool::none);
    }
    window.tap('W');
    window.tap(key_code::escape);
    EXPECT_EQ(window.view.tool, HandleTool::none);
}

TEST_F(ViewHandles, ADragIsOneUndoStepAndTheFieldsFollow) {
    window.tap('W');
    const double unit = units_per_px(*window.status.viewport_camera, {});
    const glm::vec2 grip = at({60.0 * unit, 0.0, 0.0});
    const std::size_t before = window.document.history_place();
    window.drag(grip, {80.0f, 30.0f});
    EXPECT_NEAR(layer().transform.translate.x, 80.0 * unit, unit);
    EXPECT_EQ(layer().transform.translate.y, 0.0);
    EXPECT_EQ(window.document.history_place(), before + 1);
    EXPECT_EQ(window.document.undo_name(), "Position of dust");
    window.document.undo();
    EXPECT_EQ(layer().transform, LayerTransform());
}

TEST_F(ViewHandles, BesideAHandleADragOrbits) {
    window.tap('W');
    window.hover(at({0.0, 0.0, 0.0}) + glm::vec2(200.0f, 200.0f));
    window.press(0);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::orbit);
    window.release(0);
    window.hover(at({0.0, 0.0, 0.0}));
    window.press(0);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::handle);
    window.release(0);
}

TEST_F(ViewHandles, EscapeTakesTheDragBack) {
    window.tap('W');
    const std::size_t before = window.document.history_place();
    const glm::vec2 grip = at({0.0, 0.0, 0.0});
    window.hover(grip);
    window.press(0);
    window.move(grip + glm::vec2(50.0f, 20.0f));
    window.frame();
    EXPECT_NE(layer().transform, LayerTransform());
    window.tap(key_code::escape);
    EXPECT_EQ(layer().transform, LayerTransform());
    window.move(grip + glm::vec2(90.0f, 20.0f));
    window.frame();
    window.release(0);
    EXPECT_EQ(layer().transform, LayerTransform());
    EXPECT_EQ(window.document.history_place(), before);
    EXPECT_FALSE(window.document.can_redo());
    EXPECT_EQ(window.view.tool, HandleTool::move) << "only the drag is over";
}

TEST_F(ViewHandles, AnAnimatedPlaceGetsAKeyframe) {
    window.document.edit("Animate", [](Scene& scene) {
        Track track;
        track.key = "layer.dust.transform.translate";
        track.keyframes = {{1.0, {0.0, 0.0, 0.0}, {}}};
        scene.animation.push_back(track);
    });
    window.view.frame = 12.0;
    window.frame();
    window.tap('W');
    window.drag(at({0.0, 0.0, 0.0}), {50.0f, 0.0f});
    ASSERT_EQ(window.document.scene().animation.back().keyframes.size(), 2u);
    EXPECT_EQ(window.document.scene().animation.back().keyframes[1].frame, 12.0);
}

TEST_F(ViewHandles, TheCamerasTargetIsMovedAndSaidSo) {
    window.choose("Camera/Move the target in the view");
    EXPECT_EQ(window.view.handle_target, HandleTarget::camera_target);
    window.drag(at({0.0, 0.0, 0.0}), {0.0f, 50.0f});
    EXPECT_LT(window.document.scene().camera.target.y, 0.0);
    EXPECT_EQ(layer().transform, LayerTransform());
    window.tap('E');
    EXPECT_EQ(window.view.handle_target, HandleTarget::layer);
}

TEST_F(ViewHandles, BoxesGridAndAxesAreSwitched) {
    EXPECT_EQ(count(color::accent), 0);
    window.choose("View/Guides/Box of the selected layer");
    EXPECT_TRUE(window.view.selected_box);
    window.choose("View/Guides/Boxes of all layers");
    window.choose("View/Guides/Grid");
    window.choose("View/Guides/Axes");
    window.choose("View/Guides/Scale bar");
    EXPECT_TRUE(window.view.all_boxes && window.view.grid && window.view.axes && window.view.scale_bar);
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.selected_box);
}

TEST_F(ViewHandles, MarksAreDrawnOnceTheyAreAskedFor) {
    window.hover({5.0f, 5.0f});
    const auto drawn = [&](bool ViewState::*flag) {
        const Picture8 before = window.picture();
        window.view.*flag = true;
        window.frame(2);
        const Picture8 after = window.picture();
        window.view.*flag = false;
        window.frame(2);
        int changed = 0;
        for (std::size_t i = 0; i < after.pixels.size(); ++i)
            changed += after.pixels[i].r != before.pixels[i].r || after.pixels[i].g != before.pixels[i].g;
        return changed;
    };
    EXPECT_GT(drawn(&ViewState::selected_box), 500);
    EXPECT_GT(drawn(&ViewState::all_boxes), 500);
    EXPECT_GT(drawn(&ViewState::grid), 500);
    EXPECT_GT(drawn(&ViewState::axes), 500);
    window.status.viewport_camera.reset();
    EXPECT_EQ(drawn(&ViewState::grid), 0) << "without a camera";
}

// 20 units of 7 light years over the height: the longest that is drawn is of 50, 20 or 10.
TEST_F(ViewHandles, TheScaleBarIsAsLongAsItSays) {
    window.view.view = ViewKind::free;
    const auto longest_run = [&] {
        window.move({5.0f, 5.0f});
        window.frame(2);
        const Picture8 picture = window.picture();
        const ImVec4 ink = color4(color::text);
        const int y = int(area.y + area.height) - 48;
        int run = 0, longest = 0;
        for (int x = int(area.x); x < int(area.x + area.width); ++x) {
            const bool lit = std::abs(int(picture.at(x, y).r) - int(255 * ink.x)) < 6;
            run = lit ? run + 1 : 0;
            longest = std::max(longest, run);
        }
        return longest;
    };
    EXPECT_LT(longest_run(), 10);
    window.view.scale_bar = true;
    const double units_per_px = 20.0 / double(area.height);
    EXPECT_NEAR(longest_run(), scale_bar(units_per_px, 0.0, 160.0).length_px, 3.0);
    window.document.edit("Scale", [](Scene& scene) { scene.light_years_per_unit = 7.0; });
    EXPECT_NEAR(longest_run(), scale_bar(units_per_px, 7.0, 160.0).length_px, 3.0);
    EXPECT_GT(std::fabs(scale_bar(units_per_px, 7.0, 160.0).length_px -
                        scale_bar(units_per_px, 0.0, 160.0).length_px),
              10.0);
    window.status.viewport_camera.reset();
    EXPECT_LT(longest_run(), 10) << "without a camera";
}

TEST_F(ViewHandles, ANewCropFitsTheLayerAndHasHandles) {
    const glm::dvec3 extent = window.status.layers[0].box.extent();
    window.view.tab = PanelTab::look;
    window.frame(2);
    window.document.edit("Crop", [](Scene& scene) { scene.layers[0].look.crop.resize(1); });
    window.view.tool = HandleTool::move;
    window.view.handle_target = HandleTarget::crop;
    window.frame(2);
    window.drag(at({0.0, 0.0, 0.0}), {50.0f, 0.0f});
    EXPECT_GT(layer().look.crop[0].center.x, 0.0f);
    EXPECT_GT(extent.x, 0.0);
    EXPECT_EQ(window.document.undo_name(), "Centre of dust");
}

// Lasso, box and brush.

class ViewSelecting : public ViewHandles {
  protected:
    const std::vector<Crop>& crops() const { return layer().look.crop; }
    std::vector<glm::vec2> points() const { return outline_lines(crops().back().outline).at(0); }
};

TEST_F(ViewSelecting, ABoxIsErasedInOneStep) {
    window.tap('M');
    EXPECT_EQ(window.view.select, SelectTool::box);
    window.frame(2);
    window.drag(at({1.0, 2.0, 0.0}), at({3.0, 5.0, 0.0}) - at({1.0, 2.0, 0.0}));
    ASSERT_EQ(crops().size(), 1u);
    EXPECT_EQ(crops()[0].keep, Crop::Keep::outside);
    EXPECT_TRUE(crops()[0].parallel);
    ASSERT_EQ(points().size(), 4u);
    EXPECT_LT(glm::distance(points()[0], glm::vec2(1.0f, 2.0f)), 0.02f);
    EXPECT_LT(glm::distance(points()[2], glm::vec2(3.0f, 5.0f)), 0.02f);
    EXPECT_EQ(window.document.undo_name(), "Erase a part of dust");
    window.document.undo();
    EXPECT_TRUE(crops().empty());
    EXPECT_EQ(window.view.view, ViewKind::camera) << "the view did not turn";
    window.drag(at({1.0, 2.0, 0.0}), {1.0f, 0.0f});
    EXPECT_TRUE(crops().empty()) << "a click";
    window.tap(key_code::escape);
    EXPECT_EQ(window.view.select, SelectTool::none);
}

TEST_F(ViewSelecting, TheBarChoosesToolAndFate) {
    window.tap('L');
    window.frame(2);
    window.click("select tool/Brush");
    window.click("selection/To a layer");
    window.frame(2);
    const float before = window.view.brush_px;
    window.tap(']');
    EXPECT_GT(window.view.brush_px, before);
    window.tap('[');
    window.drag(at({-2.0, 0.0, 0.0}), at({2.0, 0.0, 0.0}) - at({-2.0, 0.0, 0.0}));
    ASSERT_EQ(window.document.scene().layers.size(), 4u);
    EXPECT_EQ(crops().size(), 1u);
    EXPECT_EQ(window.document.scene().layers[1].look.crop.size(), 1u);
    EXPECT_NEAR(crops()[0].width, 2.0f * before * 20.0f / area.height, 0.02f);
    window.click("close selecting");
    EXPECT_EQ(window.view.select, SelectTool::none);
    EXPECT_EQ(window.view.layer, 0u) << "what is left stays selected";
}

TEST_F(ViewSelecting, EscapeDropsWhatIsBeingDrawn) {
    window.tap('L');
    window.frame(2);
    window.hover(at({0.0, 0.0, 0.0}));
    window.press();
    window.hover(at({2.0, 0.0, 0.0}));
    window.hover(at({2.0, 2.0, 0.0}));
    window.tap(key_code::escape);
    window.release();
    EXPECT_TRUE(crops().empty());
    EXPECT_EQ(window.view.select, SelectTool::lasso) << "the tool stays";
}

TEST_F(ViewSelecting, OutlinesAreForgottenTogether) {
    window.tap('M');
    window.frame(2);
    window.drag(at({1.0, 2.0, 0.0}), {90.0f, 60.0f});
    window.drag(at({-3.0, 2.0, 0.0}), {90.0f, 60.0f});
    window.document.edit("Crop", [](Scene& scene) { scene.layers[0].look.crop.emplace_back(); });
    ASSERT_EQ(crops().size(), 3u);
    window.choose("Layer/Select/Forget what was drawn");
    ASSERT_EQ(crops().size(), 1u);
    EXPECT_EQ(crops()[0].shape, Crop::Shape::box);
}

/// A galaxy's picture before its own camera.
class LyingHandlesTest : public testing::Test {
  protected:
    LyingHandlesTest() {
        const CameraParams& seen = window.document.scene().camera;
        window.status.viewport_camera = make_camera(seen, double(area.width), double(area.height), {});
        window.status.layers.resize(1);
        window.view.start = PictureStart{"m77.jpg"};
        window.view.start->guesses = {{SkyObject::galaxy, 0.95}};
        window.view.start->seen = "seen at 60 degrees";
        window.frame(2);
    }
    const GalaxyParams& galaxy() const { return window.document.scene().layers[0].source.structure.galaxy; }
    TestWindow window{Document::untitled(test::inclined_scene, "/tmp/m77.toml")};
    Rect area = make_layout(window.view, 1600.0f, 900.0f, 1.0f).viewport;
    glm::vec2 middle() { return 0.5f * (window.at("lying 0 major") + window.at("lying 0 major other")); }
};

TEST_F(LyingHandlesTest, ADragIsOneStepAndTheCardStaysAndSaysIt) {
    const glm::vec2 end = window.at("lying 0 minor far");
    window.drag(end, 0.6f * (end - middle()));
    EXPECT_NEAR(*galaxy().inclination, 36.9, 1.0);
    EXPECT_EQ(window.document.undo_name(), "Inclination of m77");
    EXPECT_TRUE(window.view.start) << "what it was taken for is as it was";
    window.keep_screen("lying");
    window.drag(window.at("lying 0 major"), {0.0f, -60.0f});
    EXPECT_GT(*galaxy().position_angle, 32.0);
    EXPECT_NEAR(*galaxy().near_side - *galaxy().position_angle, 90.0, 1e-6);
    window.document.undo();
    EXPECT_EQ(galaxy().position_angle, 30.0) << "with its near side one step";
    EXPECT_EQ(galaxy().near_side, 120.0);
    window.document.undo();
    EXPECT_EQ(galaxy().inclination, 60.0);
    EXPECT_FALSE(window.document.edited());
}

TEST_F(LyingHandlesTest, AClickOnAMarkTurnsItOver) {
    window.click("lying 0 far");
    EXPECT_EQ(galaxy().near_side, 300.0);
    EXPECT_EQ(galaxy().position_angle, 30.0);
    window.frame(2);
    window.click("lying 0 near");
    EXPECT_EQ(galaxy().near_side, 120.0);
}

TEST_F(LyingHandlesTest, EscapeGivesItBack) {
    const glm::vec2 end = window.at("lying 0 minor far");
    window.hover(end);
    window.press(0);
    window.move(end + 0.5f * (end - middle()));
    window.frame(2);
    EXPECT_LT(*galaxy().inclination, 50.0);
    window.tap(key_code::escape);
    EXPECT_EQ(galaxy().inclination, 60.0);
    window.release(0);
    EXPECT_FALSE(window.document.can_undo());
}

TEST_F(LyingHandlesTest, BesideItADragOrbits) {
    window.hover(middle() + glm::vec2(40.0f, 150.0f));
    window.press(0);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::orbit);
    window.release(0);
}

TEST_F(LyingHandlesTest, WithoutTheCardItIsAskedFor) {
    window.view.start.reset();
    window.frame(2);
    EXPECT_FALSE(window.has("lying 0 minor"));
    window.choose("Layer/Incline in the view");
    window.frame(2);
    EXPECT_TRUE(window.has("lying 0 minor"));
    window.tap(key_code::escape);
    window.frame(2);
    EXPECT_FALSE(window.has("lying 0 minor"));
    window.view.tab = PanelTab::source;
    window.frame(3);
    const Rect panel = make_layout(window.view, 1600.0f, 900.0f, 1.0f).panel;
    window.hover({panel.middle().x, panel.end().y - 60.0f});
    const auto y_of_row = [&] {
        for (const DrawnRow& row : window.gui.panel().rows())
            if (row.key == "layer.m77.source.structure.inclination") return row.label.y;
        return 1e9f;
    };
    while (y_of_row() > panel.end().y - 80.0f) {
        window.wheel(-1.0f);
        window.frame(2);
    }
    window.hover({panel.x + 30.0f, y_of_row()});
    EXPECT_TRUE(window.has("lying 0 minor")) << "its row is under the mouse";
    window.hover({5.0f, 5.0f});
    EXPECT_FALSE(window.has("lying 0 minor"));
}

// The camera's keyframes as points in the view, by mouse.

struct PathPointsTest : testing::Test {
    TestWindow window{example_document()};
    Rect area = make_layout(window.view, 1600.0f, 900.0f, 1.0f).viewport;
    Camera camera;
    PathPointsTest() {
        CameraParams params;
        params.position = glm::dvec3(0.0, 40.0, 0.01);  // from above: right is +x, down +z
        camera = make_camera(params, double(area.width), double(area.height), {});
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
    window.hover(from);
    window.press();
    window.frame(2);
    window.hover(from + glm::vec2(40, 0));
    EXPECT_FALSE(position(1) == glm::dvec3(8.0, 3.0, 8.0));
    window.tap(key_code::escape);
    window.hover(from + glm::vec2(80, 0));
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
