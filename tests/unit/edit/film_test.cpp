// Stills that become films by their first keyframe at a later frame.
#include "edit/edit_rules.h"

#include <gtest/gtest.h>

#include "edit/document.h"
#include "edit/keyframes.h"
#include "scenes.h"

namespace astrosplat {
namespace {

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
