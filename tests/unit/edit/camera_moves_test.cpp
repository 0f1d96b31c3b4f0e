// Keyframes as they are edited, of cameras and of any track, and camera moves.
#include "edit/view_camera.h"

#include "camera/framing.h"
#include "edit/document.h"
#include "edit/edits.h"
#include "scene/animate.h"
#include "scenes.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Camera keyframes and moves: circles are round, ends rest, keyframes outside the move stay.

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

// Editing tracks: keys appear, change, move and vanish where asked, and what comes out loads again.

using Frames = std::vector<double>;
using test::opacity;

const std::string core = "layer.stars.render.core";  // keys at 1 and 24, smooth

struct Keyframes : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");

    Frames frames_of(const std::string& key) const { return test::frames_of(scene, key); }
};

TEST_F(Keyframes, AreFound) {
    EXPECT_TRUE(is_animated(scene, core));
    EXPECT_FALSE(is_animated(scene, opacity));
    EXPECT_EQ(find_track(scene, opacity), nullptr);
    EXPECT_TRUE(has_keyframe_at(scene, core, 24.0));
    EXPECT_FALSE(has_keyframe_at(scene, core, 23.0));
    EXPECT_FALSE(has_keyframe_at(scene, opacity, 24.0));
}

TEST_F(Keyframes, AreAddedInOrderAndReplaced) {
    set_keyframe(scene, core, 12.0, 0.9);
    set_keyframe(scene, core, -3.0, 0.1);
    EXPECT_EQ(frames_of(core), (Frames{-3, 1, 12, 24}));
    set_keyframe(scene, core, 12.0, 0.8);
    EXPECT_EQ(frames_of(core), (Frames{-3, 1, 12, 24}));
    EXPECT_EQ(find_track(scene, core)->keyframes[2].value, Frames{0.8});
    EXPECT_EQ(find_track(scene, core)->keyframes[2].interpolation, Interpolation::smooth);  // the track's
}

TEST_F(Keyframes, KeepTheirInterpolationWhenSetAgain) {
    set_interpolation(scene, core, 24.0, Interpolation::step);
    set_keyframe(scene, core, 24.0, 0.25);
    EXPECT_EQ(find_track(scene, core)->keyframes[1].value, Frames{0.25});
    EXPECT_EQ(find_track(scene, core)->keyframes[1].interpolation, Interpolation::step);
    EXPECT_EQ(find_track(scene, core)->interpolation, Interpolation::smooth);
}

TEST_F(Keyframes, TheFirstMakesATrack) {
    set_keyframe(scene, opacity, 5.0, 0.25);
    ASSERT_EQ(frames_of(opacity), Frames{5});
    EXPECT_EQ(scene_at(scene, 100.0).layers[1].render.opacity, 0.25f);
    EXPECT_EQ(find_track(scene, opacity)->interpolation, Interpolation::smooth);
    set_keyframe(scene, "layer.stars.visible", 5.0, false);
    EXPECT_EQ(find_track(scene, "layer.stars.visible")->interpolation, Interpolation::linear);
    EXPECT_FALSE(scene_at(scene, 5.0).layers[1].visible);
    set_keyframe(scene, "layer.stars.render.blend", 5.0, "add");
    EXPECT_EQ(scene_at(scene, 5.0).layers[1].render.blend, Blend::add);
}

TEST_F(Keyframes, ValuesThatDoNotFitAreRefused) {
    const Scene before = scene;
    const auto message = [&](const std::string& key, const Value& value, double frame) {
        return ERROR_OF(set_keyframe(scene, key, frame, value));
    };
    EXPECT_EQ(message(core, 2.0, 1.0), core + ": expected a number from 0 to 1, found 2");
    EXPECT_EQ(message(core, 0.5, std::numeric_limits<double>::infinity()),
              core + ": expected a finite frame number, found another");
    EXPECT_EQ(message("layer.dust.source.count", std::int64_t{5}, 1.0),
              "layer.dust.source.count: this parameter cannot be animated");
    EXPECT_EQ(message("layer.dust.look.nothing", 1.0, 1.0),
              "layer.dust.look.nothing: expected a parameter of the scene, found none of that name");
    EXPECT_EQ(message("camera.position", Value::List{}, 1.0),
              "camera.position: expected 3 numbers, found none");
    EXPECT_EQ(message("camera.rotation", Value::List{0.0, 0.0, 0.0, 0.0}, 1.0),
              "camera.rotation: expected 4 numbers, found 0");
    EXPECT_EQ(scene, before);
    const Value::List two{Value::List{0.0, 1.0}, Value::List{1.0, 0.0}};
    const Value::List three{Value::List{0.0, 1.0}, Value::List{0.5, 0.5}, Value::List{1.0, 0.0}};
    set_keyframe(scene, "layer.dust.look.pdf.points", 1.0, two);
    EXPECT_EQ(message("layer.dust.look.pdf.points", three, 2.0),
              "layer.dust.look.pdf.points: expected as many points as in the other keyframes, found another "
              "number");
    set_keyframe(scene, "layer.dust.look.pdf.points", 1.0, three);  // the only key may change
}

TEST_F(Keyframes, TheLastOneLeavesItsValue) {
    remove_keyframe(scene, core, 7.0);  // there is none
    EXPECT_EQ(frames_of(core), (Frames{1, 24}));
    remove_keyframe(scene, core, 24.0);
    EXPECT_EQ(scene.layers[1].render.falloff.core, 0.5f);
    remove_keyframe(scene, core, 1.0);
    EXPECT_FALSE(is_animated(scene, core));
    EXPECT_EQ(scene.layers[1].render.falloff.core, 1.0f);
}

TEST_F(Keyframes, MoveAndCopyReplaceWhatIsThere) {
    set_keyframe(scene, core, 12.0, 0.9);
    set_interpolation(scene, core, 12.0, Interpolation::step);
    move_keyframe(scene, core, 12.0, 30.5);
    EXPECT_EQ(frames_of(core), (Frames{1, 24, 30.5}));
    EXPECT_EQ(find_track(scene, core)->keyframes[2].interpolation, Interpolation::step);
    move_keyframe(scene, core, 30.5, 1.0);
    EXPECT_EQ(frames_of(core), (Frames{1, 24}));
    EXPECT_EQ(find_track(scene, core)->keyframes[0].value, Frames{0.9});
    copy_keyframe(scene, core, 1.0, 24.0);
    EXPECT_EQ(find_track(scene, core)->keyframes[1].value, Frames{0.9});
    copy_keyframe(scene, core, 1.0, 48.0);
    EXPECT_EQ(frames_of(core), (Frames{1, 24, 48}));
    const Scene before = scene;
    move_keyframe(scene, core, 2.0, 3.0);
    copy_keyframe(scene, core, 2.0, 3.0);
    move_keyframe(scene, opacity, 1.0, 3.0);
    move_keyframe(scene, core, 24.0, 24.0);
    EXPECT_EQ(scene, before);
}

TEST_F(Keyframes, EndsAndWholeTracks) {
    set_ends(scene, core, Ends::through);
    EXPECT_EQ(find_track(scene, core)->ends, Ends::through);
    remove_track(scene, core);
    EXPECT_FALSE(is_animated(scene, core));
    EXPECT_EQ(scene.layers[1].render.falloff.core, 0.5f);  // as below the track all along
}

TEST_F(Keyframes, FramesOfAllTracks) {
    EXPECT_EQ(frames_with_keyframes(scene), (Frames{1, 24, 48}));
    EXPECT_EQ(frame_of_next_keyframe(scene, 1.0), 24.0);
    EXPECT_EQ(frame_of_next_keyframe(scene, 23.5), 24.0);
    EXPECT_EQ(frame_of_next_keyframe(scene, 48.0), 48.0);
    EXPECT_EQ(frame_of_previous_keyframe(scene, 48.0), 24.0);
    EXPECT_EQ(frame_of_previous_keyframe(scene, 47.0), 24.0);
    EXPECT_EQ(frame_of_previous_keyframe(scene, 1.0), 1.0);
    EXPECT_EQ(frame_of_previous_keyframe(scene, -7.0), -7.0);
}

TEST(KeyframesInAFile, AreSavedAndLoaded) {
    const test::SceneFolder f;
    Document document = Document::open(f.file);
    document.edit("Keyframes", [](Scene& s) {
        set_keyframe(s, opacity, 1.0, 0.0);
        set_keyframe(s, opacity, 24.0, 1.0);
        set_interpolation(s, opacity, 24.0, Interpolation::step);
        set_keyframe(s, "camera.position", 1.0, Value::List{0.0, 1.0, 9.5});
        move_keyframe(s, core, 24.0, 30.0);
    });
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
    EXPECT_EQ(document.scene().animation.size(), 4u);
}

// Editing handles of Bezier keyframes: kinds, joined and broken ones.

struct KeyframeHandles : testing::Test {
    using Numbers = std::vector<double>;
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");
    const std::string fov = "camera.fov", position = "camera.position";
    KeyframeHandles() {
        set_keyframe(scene, fov, 0.0, 20.0);
        set_keyframe(scene, fov, 12.0, 32.0);
        set_keyframe(scene, fov, 36.0, 56.0);
        set_keyframe(scene, position, 0.0, Value::List{0.0, 0.0, 9.0});
        set_keyframe(scene, position, 12.0, Value::List{6.0, 0.0, 9.0});
        for (const Track& track : scene.animation)
            for (const auto& keyframe : track.keyframes)
                set_interpolation(scene, track.key, keyframe.frame, Interpolation::bezier);
    }
    Keyframe<Numbers> at(const std::string& key, double frame) const {
        for (const auto& keyframe : find_track(scene, key)->keyframes)
            if (keyframe.frame == frame) return keyframe;
        ADD_FAILURE() << key << " has no keyframe at " << frame;
        return {0.0, {}, Interpolation::linear};
    }
    double fov_at(double frame) const { return scene_at(scene, frame).camera.fov; }
};

TEST_F(KeyframeHandles, FlatOnesRestAtTheKeyframe) {
    set_handle_kind(scene, fov, 12.0, HandleKind::flat);
    EXPECT_NEAR(fov_at(6.0), 26.0, 1e-9);  // both ends rest
    EXPECT_NEAR(fov_at(12.01), 32.0, 1e-4);
    set_handle_kind(scene, fov, 12.0, HandleKind::automatic);
    EXPECT_GT(fov_at(12.01), 32.005);
}

TEST_F(KeyframeHandles, EaseOneSideOrBoth) {
    for (const double frame : {0.0, 12.0, 36.0}) set_interpolation(scene, fov, frame, Interpolation::linear);
    const auto speed = [&](double frame) { return (fov_at(frame + 0.01) - fov_at(frame - 0.01)) / 0.02; };
    const double before = speed(11.9), after = speed(12.1);
    ASSERT_GT(before, 0.5);
    ASSERT_GT(after, 0.5);
    ease(scene, fov, 12.0, HandleSide::in);
    EXPECT_LT(speed(11.9), 0.1 * before);
    EXPECT_NEAR(speed(12.1), after, 1e-9);
    EXPECT_TRUE(at(fov, 12.0).broken);
    ease(scene, fov, 12.0, HandleSide::out);
    EXPECT_LT(speed(12.1), 0.1 * after);
    EXPECT_FALSE(at(fov, 12.0).broken);
    EXPECT_EQ(fov_at(12.0), 32.0);
    const Scene eased = scene;
    ease(scene, fov, 0.0, HandleSide::in);  // no segments
    ease(scene, fov, 36.0, HandleSide::out);
    ease(scene, fov, 13.0, HandleSide::out);
    EXPECT_EQ(scene, eased);
}

TEST_F(KeyframeHandles, BecomeFreeWhereTheyAre) {
    const double before = fov_at(7.0), after = fov_at(20.0);
    set_handle_kind(scene, fov, 12.0, HandleKind::free);
    EXPECT_EQ(at(fov, 12.0).in.kind, HandleKind::free);
    EXPECT_EQ(at(fov, 12.0).in.frames, -4.0);
    EXPECT_EQ(at(fov, 12.0).out.frames, 8.0);
    EXPECT_NEAR(at(fov, 12.0).out.value[0], 8.0, 1e-12);  // one degree a frame
    EXPECT_NEAR(fov_at(7.0), before, 1e-12);
    EXPECT_NEAR(fov_at(20.0), after, 1e-12);
    set_handle_kind(scene, fov, 36.0, HandleKind::free);
    EXPECT_EQ(at(fov, 36.0).out.kind, HandleKind::automatic) << "there is no segment after it";
}

TEST_F(KeyframeHandles, JoinedOnesTurnTogether) {
    set_handle(scene, fov, 12.0, HandleSide::out, 6.0, {-3.0});
    EXPECT_EQ(at(fov, 12.0).out.value, Numbers{-3.0});
    EXPECT_EQ(at(fov, 12.0).in.frames, -4.0);
    EXPECT_EQ(at(fov, 12.0).in.value, Numbers{2.0});
    set_handle(scene, fov, 12.0, HandleSide::in, -2.0, {2.0});
    EXPECT_EQ(at(fov, 12.0).out.value, Numbers{-6.0});
}

TEST_F(KeyframeHandles, BrokenOnesMoveOneByOneUntilTheyAreJoined) {
    set_broken(scene, fov, 12.0, true);
    set_handle(scene, fov, 12.0, HandleSide::out, 6.0, {-3.0});
    EXPECT_EQ(at(fov, 12.0).in.kind, HandleKind::automatic);
    set_handle(scene, fov, 12.0, HandleSide::in, -4.0, {-1.0});
    EXPECT_EQ(at(fov, 12.0).out.value, Numbers{-3.0});
    set_broken(scene, fov, 12.0, false);
    EXPECT_EQ(at(fov, 12.0).in.value, Numbers{2.0});
}

TEST_F(KeyframeHandles, StayOnTheirSideOfTheKeyframe) {
    set_handle(scene, fov, 12.0, HandleSide::out, -5.0, {1.0});
    EXPECT_EQ(at(fov, 12.0).out.frames, 0.0);
}

TEST_F(KeyframeHandles, OfPositionsAreVectors) {
    set_handle(scene, position, 0.0, HandleSide::out, 4.0, {0.0, 3.0, 0.0});
    const glm::dvec3 half_way = *scene_at(scene, 6.0).camera.position;
    EXPECT_NEAR(half_way.y, 3.0 * 3.0 / 8.0, 1e-9);  // 3 u (1-u)^2 at the middle
    EXPECT_NEAR(half_way.x, 3.0, 1e-9);
}

TEST_F(KeyframeHandles, StayWhereAValueIsChanged) {
    set_handle(scene, fov, 12.0, HandleSide::out, 6.0, {-3.0});
    set_keyframe(scene, fov, 12.0, 35.0);
    EXPECT_EQ(at(fov, 12.0).value, Numbers{35.0});
    EXPECT_EQ(at(fov, 12.0).out.value, Numbers{-3.0});
    set_keyframe(scene, fov, 20.0, 35.0);
    EXPECT_EQ(at(fov, 20.0).interpolation, Interpolation::bezier) << "it lies in a Bezier segment";
}

TEST_F(KeyframeHandles, OfWhatIsNotAnimatedAreLeftAlone) {
    const Scene before = scene;
    set_handle(scene, "camera.roll", 12.0, HandleSide::out, 4.0, {1.0});
    set_handle_kind(scene, fov, 13.0, HandleKind::flat);
    set_broken(scene, fov, 13.0, true);
    EXPECT_EQ(scene, before);
}

// Stills that become films by their first keyframe at a later frame.

/// edit_scene with these frames, at 24 fps, in which nothing moves.
Document document_of(const std::string& frames) {
    Document document = Document::untitled(test::edit_scene, "/scene.toml");
    document.edit("Frames", [&](Scene& scene) {
        scene.output.frames = frames;
        scene.animation.clear();
    });
    return document;
}

void set_opacity(Document& document, double frame) {
    document.edit("Set keyframe", [&](Scene& scene) { set_keyframe(scene, test::opacity, frame, 0.25); });
}

TEST(Film, AStillsFirstLaterKeyframeMakesItOne) {
    Document document = document_of("7");
    set_opacity(document, 7.0);
    EXPECT_EQ(document.scene().output.frames, "7");
    document.set(test::opacity, 0.75, 90.0);  // animated: a keyframe
    EXPECT_EQ(document.scene().output.frames, "7-246");
    set_opacity(document, 300.0);
    EXPECT_EQ(document.scene().output.frames, "7-246") << "its length is somebody's choice";
    document.undo();
    document.undo();
    EXPECT_EQ(document.scene().output.frames, "7");
}

TEST(Film, ReachesToTheKeyframe) {
    Document document = document_of("1");
    set_opacity(document, 300.0);
    EXPECT_EQ(document.scene().output.frames, "1-300");
}

TEST(Film, KeepsFramesThatWereChosen) {
    Document film = document_of("1-9x2");
    set_opacity(film, 20.0);
    EXPECT_EQ(film.scene().output.frames, "1-9x2");
    Document one_of_a_film = document_of("1-48");
    set_opacity(one_of_a_film, 40.0);
    one_of_a_film.edit("Frames", [](Scene& scene) { scene.output.frames = "12"; });
    EXPECT_EQ(one_of_a_film.scene().output.frames, "12");
    set_opacity(one_of_a_film, 44.0);
    EXPECT_EQ(one_of_a_film.scene().output.frames, "12");
}

}  // namespace
}  // namespace astrosplat
