// The scene's camera in other views, and frames that are played.
#include <gtest/gtest.h>

#include <algorithm>

#include "edit/edits.h"
#include "edit/view_camera.h"
#include "unit/edit/scenes.h"
#include "viewer/view_motion.h"

namespace astrosplat {
namespace {

// The scene's camera as other views show it. Seen through itself, its frame is the picture's edge.

using Line = CameraOverlay::Line;

struct CameraOverlayTest : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");  // 640 x 360 px
    Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
    ViewRequest request;
    Rect place{10.0f, 20.0f, 320.0f, 180.0f};
    CameraOverlay overlay;
    CameraOverlayTest() {
        request.scene = scene;
        request.box = box;
        request.width = 640;
        request.height = 360;
    }
    std::vector<Line> lines() { return overlay.lines(scene, scene, box, request, place); }
    bool has_line(const Line& wanted) {
        const std::vector<Line> all = lines();
        return std::any_of(all.begin(), all.end(), [&](const Line& line) {
            return std::equal(line.begin(), line.end(), wanted.begin(), wanted.end(),
                              [](const glm::vec2& a, const glm::vec2& b) {
                                  return std::abs(a.x - b.x) < 0.01f && std::abs(a.y - b.y) < 0.01f;
                              });
        });
    }
};

TEST_F(CameraOverlayTest, FrameAndTheMarkAboveItLieAtThePicturesEdge) {
    EXPECT_TRUE(has_line({{10, 20}, {330, 20}, {330, 200}, {10, 200}, {10, 20}}));
    EXPECT_TRUE(has_line({{138, 12.8f}, {170, -8.8f}, {202, 12.8f}, {138, 12.8f}}));
}

TEST_F(CameraOverlayTest, AViewFromElsewhereSeesTheWholeFrustum) {
    request.scene.camera.position = glm::dvec3(30.0, 4.0, 10.0);
    request.scene.camera.target =
        glm::dvec3(0.0, 4.0, 10.0);  // the scene's camera, which is so in the middle
    const std::vector<Line> all = lines();
    ASSERT_GE(all.size(), 6u);
    for (std::size_t i = 0; i < 4; ++i) {  // from the eye to the corners
        ASSERT_EQ(all[i].size(), 2u);
        EXPECT_NEAR(all[i][0].x, 170.0f, 0.01f);
        EXPECT_NEAR(all[i][0].y, 110.0f, 0.01f);
        EXPECT_GT(all[i][1].y, 110.0f - 180.0f);
    }
}

TEST_F(CameraOverlayTest, ACameraThatCannotBeMadeHasNoLines) {
    request.scene.camera.fov = 0.0;
    EXPECT_TRUE(lines().empty());
}

// Mouse over the viewport: when the view leaves the scene's camera, and where it stands then.

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

// Playing: the scene's frames at its speed, round and round, whatever the clock does.

struct PlaybackTest : testing::Test {
    Playback playback;
    ViewState view;
    OutputParams output;
    PlaybackTest() {
        output.frames = "10-12";
        output.fps = 4.0;
        view.frame = 10.0;
        view.playing = true;
    }
    double frame_at(double now) {
        playback.advance(view, output, now);
        return view.frame;
    }
};

TEST_F(PlaybackTest, AfterTheLastFrameComesTheFirst) {
    EXPECT_EQ(frame_at(100.0), 10.0);
    EXPECT_EQ(frame_at(100.125), 10.0);
    EXPECT_EQ(frame_at(100.25), 11.0);
    EXPECT_EQ(frame_at(100.5), 12.0);
    EXPECT_EQ(frame_at(100.75), 10.0);
}

TEST_F(PlaybackTest, FramesThatCannotBeDrawnInTimeAreLeftOut) {
    output.frames = "10-100";
    frame_at(100.0);
    EXPECT_EQ(frame_at(101.125), 14.0);
    EXPECT_EQ(frame_at(101.25), 15.0);  // the eighth of a second is not lost
}

TEST_F(PlaybackTest, APauseIsNotCaughtUp) {
    frame_at(100.0);
    view.playing = false;
    EXPECT_EQ(frame_at(101.0), 10.0);
    view.playing = true;
    EXPECT_EQ(frame_at(102.0), 10.0);
    EXPECT_EQ(frame_at(102.25), 11.0);
}

TEST_F(PlaybackTest, InAndOutPointsBoundIt) {
    output.frames = "1-100";
    view.play_first = 20.0;
    view.play_last = 22.0;
    frame_at(100.0);
    EXPECT_EQ(frame_at(100.25), 20.0);  // from outside
    EXPECT_EQ(frame_at(100.5), 21.0);
    EXPECT_EQ(frame_at(100.75), 22.0);
    EXPECT_EQ(frame_at(101.0), 20.0);
    view.play_last = 7.0;  // before the in point: as if it were not there
    for (int i = 0; i < 5; ++i) frame_at(101.25 + 0.25 * i);
    EXPECT_EQ(view.frame, 25.0);
}

TEST_F(PlaybackTest, ThereAndBackShowsTheEndsOnce) {
    view.play_mode = PlayMode::ping_pong;
    frame_at(100.0);
    std::vector<double> seen;
    for (int i = 1; i <= 6; ++i) seen.push_back(frame_at(100.0 + 0.25 * i));
    EXPECT_EQ(seen, (std::vector<double>{11, 12, 11, 10, 11, 12}));
}

TEST_F(PlaybackTest, OnceStopsAtTheEndAndBeginsAgain) {
    view.play_mode = PlayMode::once;
    frame_at(100.0);
    frame_at(100.25);
    frame_at(100.5);
    EXPECT_TRUE(view.playing);
    EXPECT_EQ(frame_at(100.75), 12.0);
    EXPECT_FALSE(view.playing);
    frame_at(101.0);
    view.playing = true;
    EXPECT_EQ(frame_at(102.0), 10.0);
}

TEST_F(PlaybackTest, EveryFrameIsShownAndTheRateToldAsItIs) {
    output.frames = "10-100";
    view.every_frame = true;
    frame_at(100.0);
    for (int i = 1; i <= 4; ++i) EXPECT_EQ(frame_at(100.0 + 0.5 * i), 10.0 + i);  // 2 a second, not 4
    EXPECT_NEAR(playback.shown_fps(), 2.0, 1e-9);
    view.every_frame = false;
    for (int i = 1; i <= 8; ++i) frame_at(102.0 + 0.25 * i);
    EXPECT_NEAR(playback.shown_fps(), 4.0, 1e-9);
}

TEST(FirstFrame, IsTheEarliest) {
    Scene scene;
    scene.output.frames = "7-9,3";
    EXPECT_EQ(frame_range(scene.output).first, 3.0);
}

}  // namespace
}  // namespace astrosplat
