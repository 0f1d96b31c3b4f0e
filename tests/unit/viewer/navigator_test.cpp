// Mouse over the viewport: when the view leaves the scene's camera, and where it stands then.
#include "viewer/viewport_camera.h"

#include <gtest/gtest.h>

#include "edit/view_camera.h"
#include "unit/edit/scenes.h"

namespace astrosplat {
namespace {

using Drag = ViewportInput::Drag;

struct NavigatorTest : testing::Test {
    test::SceneFolder folder;
    Document document = Document::open(folder.file);
    ViewState view;
    ViewRequest request;
    Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
    ShownView shown{request, {640.0, 360.0}, box};
    Navigator navigator;
    NavigatorTest() {
        request.scene = document.scene();
        request.box = box;
        request.width = 640;
        request.height = 360;
        view.view = ViewKind::camera;
    }
    bool left_camera(const ViewportInput& input) {
        view.view = ViewKind::camera;
        return navigator.navigate(input, shown, 1.0, document, view);
    }
};

ViewportInput dragged(Drag drag, const glm::dvec2& by) {
    ViewportInput input;
    input.hovered = true;
    input.drag = drag;
    input.delta_px = by;
    return input;
}

TEST_F(NavigatorTest, OnlyAMoveLeavesTheCamera) {
    for (const Drag drag : {Drag::orbit, Drag::pan, Drag::dolly, Drag::look}) {
        EXPECT_FALSE(left_camera(dragged(drag, {0.0, 0.0})));
        EXPECT_EQ(view.view, ViewKind::camera);
        EXPECT_TRUE(left_camera(dragged(drag, {3.0, 0.0})));
        EXPECT_EQ(view.view, ViewKind::free);
    }
    EXPECT_FALSE(left_camera(dragged(Drag::none, {3.0, 0.0})));
    EXPECT_FALSE(left_camera(dragged(Drag::wipe, {3.0, 0.0})));
    ViewportInput input;
    input.wheel = 1.0f;
    EXPECT_FALSE(left_camera(input));  // over another part of the window
    input.hovered = true;
    EXPECT_TRUE(left_camera(input));
}

TEST_F(NavigatorTest, ALockedCameraIsEditedOneStepAGesture) {
    view.lock_to_camera = true;
    const CameraParams before = document.scene().camera;
    ViewportInput input = dragged(Drag::orbit, {5.0, 0.0});
    input.drag_begins = true;
    EXPECT_FALSE(left_camera(input));
    input.drag_begins = false;
    EXPECT_FALSE(left_camera(input));
    EXPECT_EQ(view.view, ViewKind::camera);
    EXPECT_NE(document.scene().camera.position, before.position);
    document.undo();
    EXPECT_EQ(document.scene().camera, before);
    EXPECT_FALSE(document.can_undo());
}

TEST_F(NavigatorTest, AFramedBoxFillsTheFreeView) {
    EXPECT_TRUE(frame_in_view(view, box, shown));
    EXPECT_EQ(view.view, ViewKind::free);
    const FreeCamera first = view.free;
    EXPECT_EQ(first.pivot, box.center());
    EXPECT_EQ(first, framed(first, box, 640.0 / 360.0));
    const Bounds half{box.center(), box.hi};
    EXPECT_FALSE(frame_in_view(view, half, shown));  // it is a free view already
    EXPECT_EQ(view.free, framed(first, half, 640.0 / 360.0));
    EXPECT_FALSE(frame_in_view(view, {}, shown));
    EXPECT_EQ(view.free.pivot, half.center());
}

}  // namespace
}  // namespace astrosplat
