// Editing handles of Bezier keyframes: kinds, joined and broken ones.
#include "edit/keyframes.h"

#include <gtest/gtest.h>

#include "scene/animate.h"
#include "scenes.h"

namespace astrosplat {
namespace {

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
    const glm::dvec3 middle = *scene_at(scene, 6.0).camera.position;
    EXPECT_NEAR(middle.y, 3.0 * 3.0 / 8.0, 1e-9);  // 3 u (1-u)^2 at the middle
    EXPECT_NEAR(middle.x, 3.0, 1e-9);
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

}  // namespace
}  // namespace astrosplat
