// Camera keyframes and moves: circles are round, ends rest, keyframes outside the move stay.
#include "edit/view_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "core/real.h"
#include "edit/edits.h"
#include "scene/animate.h"
#include "scenes.h"

namespace astrosplat {
namespace {

const Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};  // middle (1, 0, 1)
const glm::dvec3 middle(1.0, 0.0, 1.0);
constexpr double rounding = 2e-6;  // of places: 1e-7 of the distance

struct CameraMoves : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");  // 24 fps, camera at (0, 4, 10)
    CameraMoves() { scene.camera.target = middle; }
    void look_down_at_a_picture() {
        scene.camera.position = {0.0, 8.5, 0.0};
        scene.camera.target = glm::dvec3(0.0);
        scene.camera.up = {0.0, 0.0, -1.0};
    }
    Camera camera_at(double frame) const {
        return make_camera(scene_at(scene, frame).camera, 640.0, 360.0, box);
    }
    glm::dvec3 position(double frame) const { return *scene_at(scene, frame).camera.position; }
    glm::dvec3 target(double frame) const { return scene_at(scene, frame).camera.target; }
};

/// At every frame, where the eased circle is at that frame, and at the camera's height.
TEST_F(CameraMoves, AnOrbitIsWhereTheExactOneIs) {
    add_camera_move(scene, CameraMove::orbit, box, 10.0);
    const glm::dvec3 start(0.0, 4.0, 10.0), arm(-1.0, 4.0, 9.0), across(9.0, 0.0, 1.0);
    for (int step = 0; step <= 480; ++step) {
        const double frame = 10.0 + step * 0.5;
        const double t = step / 480.0, angle = 2.0 * real::pi * t * t * (3.0 - 2.0 * t);
        const glm::dvec3 exact = middle + glm::dvec3(arm.x, 0, arm.z) * real::cos(angle) +
                                 across * real::sin(angle) + glm::dvec3(0, 4, 0);
        EXPECT_LT(glm::distance(position(frame), exact), 1e-3 * std::sqrt(82.0)) << step;
        EXPECT_NEAR(position(frame).y, 4.0, 1e-9);
        EXPECT_EQ(target(frame), middle);
    }
    EXPECT_LT(glm::length(position(10.0) - start), 1e-9);
    EXPECT_LT(glm::length(position(250.0) - start), 1e-9);
}

TEST_F(CameraMoves, MovesBeginAndEndAtRest) {
    for (const CameraMove move : {CameraMove::orbit, CameraMove::fly_in, CameraMove::face_on_to_edge_on}) {
        add_camera_move(scene, move, box, 1.0);
        const double middle_speed = glm::length(position(121.5) - position(120.5));
        EXPECT_LT(glm::length(position(1.5) - position(1.0)), 0.02 * middle_speed);
        EXPECT_LT(glm::length(position(241.0) - position(240.5)), 0.02 * middle_speed);
        double last = 0.0;  // no jerk: speed never changes by more than a twentieth of its largest
        for (int i = 0; i < 240; ++i) {
            const double speed = glm::length(position(2.0 + i) - position(1.0 + i));
            if (move != CameraMove::fly_in) {
                EXPECT_LT(std::fabs(speed - last), 0.05 * middle_speed) << i;
            }
            last = speed;
        }
    }
}

TEST_F(CameraMoves, FlyInGoesStraightToTheMiddle) {
    add_camera_move(scene, CameraMove::fly_in, box, 1.0);
    const glm::dvec3 start(0.0, 4.0, 10.0), way = glm::normalize(start - middle);
    double last = 1e9;
    for (int frame = 1; frame <= 241; ++frame) {
        const glm::dvec3 arm = position(frame) - middle;
        EXPECT_LT(glm::length(glm::cross(arm, way)), 1e-6);
        EXPECT_LE(glm::length(arm), last + 1e-9);
        last = glm::length(arm);
    }
    EXPECT_NEAR(last, 0.15 * glm::length(start - middle), 1e-9);
}

TEST_F(CameraMoves, FaceOnToEdgeOnIsAQuarterCircle) {
    add_camera_move(scene, CameraMove::face_on_to_edge_on, box, 1.0);
    const double distance = glm::length(position(1.0) - middle);
    const glm::dvec3 side = glm::normalize(glm::dvec3(-1.0, 0.0, 9.0));  // where the camera was
    EXPECT_NEAR(glm::dot(glm::normalize(position(1.0) - middle), {0, 1, 0}), 1.0, 1e-5);
    EXPECT_NEAR(glm::dot(glm::normalize(position(241.0) - middle), side), 1.0, 1e-9);
    for (int frame = 1; frame <= 241; ++frame)
        EXPECT_NEAR(glm::length(position(frame) - middle), distance, 1e-3 * distance);
    const Framing framing = frame_box(box, 40.0, 640.0 / 360.0);
    EXPECT_NEAR(distance, glm::length(framing.position - framing.target), rounding);
}

TEST_F(CameraMoves, LastTenSecondsAtAnyRateOnWholeFrames) {
    for (const double fps : {24.0, 25.0, 29.97, 60.0, 1.0}) {
        Scene s = scene;
        s.output.fps = fps;
        add_camera_move(s, CameraMove::orbit, box, 1.0);
        const Track& track = *find_track(s, "camera.position");
        EXPECT_EQ(track.keyframes.front().frame, 1.0);
        EXPECT_EQ(track.keyframes.back().frame, 1.0 + std::floor(10.0 * fps + 0.5));
        for (const auto& keyframe : track.keyframes) EXPECT_EQ(keyframe.frame, std::floor(keyframe.frame));
        EXPECT_NO_THROW(check_edited_scene(s, "scene"));
    }
}

TEST_F(CameraMoves, FramesReachToTheEndOfTheMove) {
    scene.output.fps = 24.0;
    const auto frames_after = [&](const std::string& before, double at) {
        scene.output.frames = before;
        add_camera_move(scene, CameraMove::orbit, box, at);
        return scene.output.frames;
    };
    EXPECT_EQ(frames_after("1", 1.0), "1-240");
    EXPECT_EQ(frames_after("1-100", 101.0), "1-340");
    EXPECT_EQ(frames_after("1-300", 10.0), "1-300");
    EXPECT_EQ(frames_after("1-9x2", 20.0), "1-9x2,20-259");
    EXPECT_EQ(frames_after("1-9x2,20-259", 20.0), "1-9x2,20-259");  // the same move again
}

TEST_F(CameraMoves, KeyframesOutsideTheMoveStay) {
    for (const double frame : {1.0, 50.0, 400.0})
        set_keyframe(scene, "camera.position", frame, Value::List{frame, 4.0, 10.0});
    scene.camera.rotation = glm::dvec4(0.0, 0.0, 0.0, 1.0);
    add_camera_move(scene, CameraMove::orbit, box, 48.0);
    EXPECT_TRUE(has_keyframe_at(scene, "camera.position", 1.0));
    EXPECT_TRUE(has_keyframe_at(scene, "camera.position", 400.0));
    EXPECT_FALSE(has_keyframe_at(scene, "camera.position", 50.0));
    EXPECT_FALSE(scene.camera.rotation);  // it would replace the target
}

TEST_F(CameraMoves, AFewKeyframesDescribeAMove) {
    add_camera_move(scene, CameraMove::orbit, box, 1.0);
    EXPECT_LE(find_track(scene, "camera.position")->keyframes.size(), 8u);
    add_camera_move(scene, CameraMove::face_on_to_edge_on, box, 1.0);
    EXPECT_LE(find_track(scene, "camera.position")->keyframes.size(), 4u);
    add_camera_move(scene, CameraMove::fly_in, box, 1.0);
    EXPECT_LE(find_track(scene, "camera.position")->keyframes.size(), 5u);
}

// As scenes of pictures have it, whose camera looks down the y axis.
TEST_F(CameraMoves, AnOrbitGoesAroundTheCamerasUp) {
    look_down_at_a_picture();
    add_camera_move(scene, CameraMove::orbit, box, 1.0);
    for (int frame = 1; frame <= 241; ++frame) {
        EXPECT_NEAR(glm::length(position(frame)), 8.5, 0.01) << frame;
        EXPECT_NEAR(position(frame).z, 0.0, 1e-9);
        EXPECT_NEAR(camera_at(frame).world_from_camera[1].z, -1.0, 1e-9) << "upright";
    }
    EXPECT_LT(glm::distance(position(121.0), {0.0, -8.5, 0.0}), 0.01);
    EXPECT_FALSE(is_animated(scene, "camera.up"));
}

TEST_F(CameraMoves, APictureTiltsUntilItLiesInTheFrame) {
    look_down_at_a_picture();
    add_camera_move(scene, CameraMove::face_on_to_edge_on, box, 1.0);
    EXPECT_EQ(position(1.0), glm::dvec3(0.0, 8.5, 0.0)) << "where it is";
    const glm::dmat3 axes = camera_at(1.0).world_from_camera;
    EXPECT_NEAR(axes[1].z, -1.0, 1e-9);
    for (int frame = 1; frame <= 241; ++frame) {
        EXPECT_NEAR(glm::length(position(frame)), 8.5, 0.01);
        EXPECT_NEAR(camera_at(frame).world_from_camera[0].x, axes[0].x, 1e-6) << "no roll " << frame;
    }
    EXPECT_LT(glm::distance(position(241.0), {0.0, 0.0, 8.5}), 1e-6);
    EXPECT_NEAR(camera_at(241.0).world_from_camera[1].y, 1.0, 1e-9);
}

TEST_F(CameraMoves, ATiltFromBelowBeginsThereAndKeepsLaterFrames) {
    look_down_at_a_picture();
    set_keyframe(scene, "camera.position", 1.0, Value::List{0.0, -8.5, 0.0});
    set_keyframe(scene, "camera.position", 400.0, Value::List{0.0, -8.5, 1.0});
    const glm::dmat3 later = camera_at(400.0).world_from_camera;
    add_camera_move(scene, CameraMove::face_on_to_edge_on, box, 1.0);
    EXPECT_EQ(position(1.0), glm::dvec3(0.0, -8.5, 0.0));
    for (int frame = 1; frame <= 241; ++frame)
        EXPECT_NEAR(std::fabs(camera_at(frame).world_from_camera[0].x), 1.0, 1e-6) << frame;
    EXPECT_EQ(scene_at(scene, 400.0).camera.up, glm::dvec3(0.0, 0.0, -1.0));
    EXPECT_EQ(camera_at(400.0).world_from_camera[1], later[1]);
}

TEST_F(CameraMoves, TheMiddleIsWhatTheCameraLooksAtOrThatOfTheBox) {
    const auto middle_for = [&](const glm::dvec3& looked_at) {
        scene.camera.target = looked_at;
        add_camera_move(scene, CameraMove::orbit, box, 1.0);
        const glm::dvec3 found = target(1.0);
        remove_track(scene, "camera.position");
        remove_track(scene, "camera.target");
        return found;
    };
    EXPECT_EQ(middle_for({2.0, 0.5, 3.0}), glm::dvec3(2.0, 0.5, 3.0));
    EXPECT_EQ(middle_for({2.0, 1.5, 3.0}), middle);
}

TEST_F(CameraMoves, NumbersAreShort) {
    scene.camera.position = {1.0 / 3.0, 4.0, 10.0};
    add_camera_move(scene, CameraMove::orbit, box, 1.0);
    const auto is_short = [](double v, double step) { return v == rounded_to_step(v, step); };
    for (const auto& k : find_track(scene, "camera.position")->keyframes) {
        for (const double v : k.value) EXPECT_TRUE(is_short(v, 1e-7)) << v;
        for (const double v : k.out.value) EXPECT_TRUE(is_short(v, 1e-7)) << v;
        EXPECT_TRUE(is_short(k.in.frames, 1e-3)) << k.in.frames;
    }
}

struct LaterKeyframes : CameraMoves {
    LaterKeyframes() {
        scene.output.frames = "1-480";
        for (const double frame : {1.0, 48.0, 100.0, 400.0}) {
            set_keyframe(scene, "camera.position", frame, Value::List{frame, 4.0, 10.0});
            set_keyframe(scene, "camera.fov", frame, 20.0 + frame / 40.0);
        }
        set_keyframe(scene, "camera.roll", 300.0, 5.0);
    }
    using Frames = std::vector<double>;
    Frames frames_of(const std::string& key) const { return test::frames_of(scene, key); }
};

TEST_F(LaterKeyframes, AreKeptBeyondTheMove) {
    EXPECT_EQ(camera_keyframes_after(scene, 48.0), 3u);
    add_camera_move(scene, CameraMove::orbit, box, 48.0, LaterKeys::keep);
    const Frames positions = frames_of("camera.position");
    EXPECT_EQ(positions.front(), 1.0);
    EXPECT_EQ(*(positions.end() - 2), 288.0);
    EXPECT_EQ(positions.back(), 400.0);
    EXPECT_EQ(frames_of("camera.fov"), (Frames{1, 48, 100, 400}));
    EXPECT_EQ(scene.output.frames, "1-480");
}

TEST_F(LaterKeyframes, AreShiftedBehindTheMove) {
    const glm::dvec3 before = position(100.0);
    add_camera_move(scene, CameraMove::orbit, box, 48.0, LaterKeys::shift);
    EXPECT_EQ(frames_of("camera.fov"), (Frames{1, 48, 340, 640}));
    EXPECT_EQ(frames_of("camera.roll"), (Frames{540}));
    EXPECT_EQ(frames_of("camera.position").back(), 640.0);
    EXPECT_EQ(position(340.0), before);
    EXPECT_EQ(scene.output.frames, "1-720");
}

TEST_F(LaterKeyframes, AreReplacedByTheMove) {
    add_camera_move(scene, CameraMove::orbit, box, 48.0, LaterKeys::replace);
    EXPECT_EQ(frames_of("camera.fov"), (Frames{1, 48}));
    EXPECT_EQ(frames_of("camera.roll"), Frames{});
    EXPECT_EQ(scene.camera.roll, 5.0);
    EXPECT_EQ(frames_of("camera.position").back(), 288.0);
}

TEST_F(CameraMoves, ACameraThatFramesTheBoxBeginsThere) {
    scene.camera.position.reset();
    add_camera_move(scene, CameraMove::orbit, box, 1.0);
    const glm::dvec3 framed = frame_box(box, 40.0, 640.0 / 360.0).position;
    EXPECT_LT(glm::length(position(1.0) - framed), rounding);
}

TEST_F(CameraMoves, AnEmptyBoxIsTheOrigin) {
    const glm::dvec3 above(0.0, 5.0, 0.0);  // no arm to turn
    for (const CameraMove move : {CameraMove::orbit, CameraMove::fly_in, CameraMove::face_on_to_edge_on}) {
        scene.camera.position = above;
        scene.animation.clear();
        add_camera_move(scene, move, {}, 1.0);
        for (const double frame : {1.0, 121.0, 241.0}) {
            EXPECT_EQ(target(frame), glm::dvec3(0.0));
            // An orbit that has no arm gets one as long as the camera is high.
            EXPECT_LE(glm::length(position(frame)), 5.0 * std::sqrt(2.0) + 1e-3) << frame;
        }
        EXPECT_NO_THROW(check_edited_scene(scene, "scene"));
    }
}

TEST_F(CameraMoves, CameraKeyframesHoldWhatIsAnimated) {
    set_keyframe(scene, "camera.fov", 1.0, 40.0);
    CameraParams camera;
    camera.position = glm::dvec3(1.0, 2.0, 3.0);
    camera.target = glm::dvec3(4.0, 5.0, 6.0);
    camera.fov = 30.0;
    camera.roll = 10.0;
    set_camera_keyframe(scene, camera, 12.0);
    EXPECT_EQ(position(12.0), *camera.position);
    EXPECT_EQ(target(12.0), camera.target);
    EXPECT_EQ(scene_at(scene, 12.0).camera.fov, 30.0);
    EXPECT_FALSE(is_animated(scene, "camera.roll"));
    EXPECT_FALSE(is_animated(scene, "camera.rotation"));
}

/// Every way a camera can look, through the quaternion and back.
TEST_F(CameraMoves, CameraKeyframesTurnACameraWithARotation) {
    for (const glm::dvec3& from : {glm::dvec3(3, 1, 2), glm::dvec3(-3, 0.1, 0), glm::dvec3(0, 0, -5),
                                   glm::dvec3(0.1, -4, 0.2), glm::dvec3(-1, 2, -8)}) {
        Scene s = scene;
        s.camera.rotation = glm::dvec4(0.0, 0.0, 0.0, 1.0);
        CameraParams camera;
        camera.position = from;
        camera.roll = 25.0;
        set_camera_keyframe(s, camera, 12.0);
        const CameraParams set = scene_at(s, 12.0).camera;
        ASSERT_TRUE(set.rotation);
        const glm::dmat3 wanted = make_camera(camera, 16, 9, {}).world_from_camera;
        const glm::dmat3 got = make_camera(set, 16, 9, {}).world_from_camera;
        for (int i = 0; i < 3; ++i) EXPECT_LT(glm::length(wanted[i] - got[i]), 1e-12);
    }
}

}  // namespace
}  // namespace astrosplat
