// Handles, boxes, grid and axes over the viewport: switched, dragged, taken back.
#include <gtest/gtest.h>

#include "edit/placement.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"
#include "gui/theme.h"

namespace astrosplat {
namespace {

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
        window.move({5.0f, 5.0f});
        window.frame(2);
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
    window.move(at({0.0, 0.0, 0.0}) + glm::vec2(200.0f, 200.0f));
    window.frame(2);
    window.press(0);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::orbit);
    window.release(0);
    window.move(at({0.0, 0.0, 0.0}));
    window.frame(2);
    window.press(0);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::handle);
    window.release(0);
}

TEST_F(ViewHandles, EscapeTakesTheDragBack) {
    window.tap('W');
    const std::size_t before = window.document.history_place();
    const glm::vec2 grip = at({0.0, 0.0, 0.0});
    window.move(grip);
    window.frame(2);
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
    EXPECT_TRUE(window.view.all_boxes && window.view.grid && window.view.axes);
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.selected_box);
}

TEST_F(ViewHandles, MarksAreDrawnOnceTheyAreAskedFor) {
    window.move({5.0f, 5.0f});
    window.frame(2);
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

}  // namespace
}  // namespace astrosplat
