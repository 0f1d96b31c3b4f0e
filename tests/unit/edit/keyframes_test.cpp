// Tracks as they are edited: keyframes, their handles, and stills that become films.
#include <gtest/gtest.h>

#include "edit/document.h"
#include "edit/edits.h"
#include "edit/keyframes.h"
#include "scene/animate.h"
#include "scenes.h"
#include "support/errors.h"

namespace astrosplat {
namespace {

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
