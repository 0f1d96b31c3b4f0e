// References over a frame of 400 px height whose middle is at (300, 200).
#include "scene/reference_place.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace astrosplat {
namespace {

const FrameOnScreen frame{{300.0, 200.0}, 400.0};

void expect_near(glm::dvec2 found, glm::dvec2 expected) {
    EXPECT_LT(glm::distance(found, expected), 1e-9) << found.x << ", " << found.y;
}

TEST(ReferencePlace, AtFirstItIsAsHighAsTheFrame) {
    const PicturePlace place = place_of({}, 1.5, frame);
    expect_near(place.corner, {0.0, 0.0});
    expect_near(place.right, {600.0, 0.0});
    expect_near(place.down, {0.0, 400.0});
}

TEST(ReferencePlace, PositionIsUpAndRotationCounterClockwise) {
    ReferenceParams reference;
    reference.position = {0.25, 0.5};
    reference.scale = 0.5;
    reference.rotate = 90.0;
    const PicturePlace place = place_of(reference, 2.0, frame);
    expect_near(place.right, {0.0, -400.0});
    expect_near(place.down, {200.0, 0.0});
    expect_near(place.corner, {300.0, 200.0});
}

TEST(ReferencePlace, MirroredItsLeftIsAtTheRight) {
    ReferenceParams reference;
    reference.mirrored = true;
    const PicturePlace place = place_of(reference, 1.0, frame);
    expect_near(place.corner, {500.0, 0.0});
    expect_near(place.right, {-400.0, 0.0});
}

TEST(ReferencePlace, AGripIsACornerTheInsideOrTheRest) {
    const PicturePlace place = place_of({}, 1.0, frame);
    EXPECT_EQ(grip_at(place, {105.0, 5.0}, 10.0), PlaceGrip::scale);
    EXPECT_EQ(grip_at(place, {115.0, 5.0}, 10.0), PlaceGrip::move);
    EXPECT_EQ(grip_at(place, {85.0, 5.0}, 10.0), PlaceGrip::turn);
    EXPECT_EQ(grip_at(place, {300.0, 410.0}, 10.0), PlaceGrip::turn);
}

TEST(ReferencePlace, TurnsStayWithinHalfATurn) {
    ReferenceParams reference;
    reference.rotate = 170.0;
    reference = dragged(reference, PlaceGrip::turn, {400.0, 200.0}, {300.0, 100.0}, frame);
    EXPECT_NEAR(reference.rotate, -100.0, 1e-9);
}

TEST(ReferencePlace, ScalingKeepsWhatLiesUnderTheMouse) {
    ReferenceParams reference;
    reference.position = {0.1, -0.2};
    reference.rotate = 30.0;
    const auto place_in_picture = [&](glm::dvec2 px) {
        const PicturePlace place = place_of(reference, 1.5, frame);
        const glm::dvec2 from = px - place.corner;
        return glm::dvec2(glm::dot(from, place.right) / glm::dot(place.right, place.right),
                          glm::dot(from, place.down) / glm::dot(place.down, place.down));
    };
    const glm::dvec2 mouse{123.0, 310.0}, before = place_in_picture(mouse);
    reference = scaled_about(reference, 1.7, mouse, frame);
    EXPECT_NEAR(reference.scale, 1.7, 1e-12);
    expect_near(place_in_picture(mouse), before);
}

TEST(ReferencePlace, NoDragLeavesTheRangeOfScales) {
    const ReferenceParams huge = scaled_about({}, 1e9, frame.middle, frame);
    EXPECT_EQ(huge.scale, 1e3);
    const ReferenceParams none = dragged({}, PlaceGrip::scale, {400.0, 200.0}, frame.middle, frame);
    EXPECT_EQ(none.scale, 1e-3);
    const ReferenceParams held = dragged({}, PlaceGrip::scale, frame.middle, {0.0, 0.0}, frame);
    EXPECT_EQ(held.scale, 1.0);
}

TEST(FindReference, TheViewsOwnComesBeforeThatForAny) {
    using View = ReferenceParams::View;
    Scene scene;
    EXPECT_FALSE(find_reference(scene, View::top, 1.0));
    scene.references.resize(4);
    EXPECT_FALSE(find_reference(scene, View::top, 1.0)) << "without a file there is none";
    scene.references[1].file = "any.png";
    scene.references[2].file = "top.png";
    scene.references[2].view = View::top;
    scene.references[3].file = "later.png";
    scene.references[3].frames = "10-20";
    scene.references[3].view = View::camera;
    EXPECT_EQ(find_reference(scene, View::top, 1.0), 2u);
    EXPECT_EQ(find_reference(scene, View::side, 1.0), 1u);
    EXPECT_EQ(find_reference(scene, View::camera, 9.0), 1u);
    EXPECT_EQ(find_reference(scene, View::camera, 20.5), 3u);
    EXPECT_EQ(find_reference(scene, View::camera, 21.0), 1u);
}

}  // namespace
}  // namespace astrosplat
