// The ring that says how a picture's bodies lie, and what its handles do.
#include "edit/lying.h"

#include <glm/geometric.hpp>

#include "scene/load.h"
#include "support/test.h"
#include "unit/edit/scenes.h"

namespace astrosplat {
namespace {

class LyingTest : public testing::Test {
  protected:
    Scene scene = parse_scene(test::inclined_scene, "/tmp/scene.toml");
    Camera front = make_camera(scene.camera, 1600.0, 1000.0, {});
    using Of = LyingGrip::Of;

    std::vector<LyingRing> rings() const { return lying_rings(scene, 0); }
    LyingRing ring() const { return rings().at(0); }
    StructureParams& structure() { return scene.layers[0].source.structure; }
    glm::dvec2 px(const LyingRing& of, LyingGrip::Of grip, const Camera& camera) const {
        for (const SeenGrip& seen : grips_of(camera, of))
            if (seen.of == grip) return seen.px;
        ADD_FAILURE();
        return {};
    }
    LyingRing drawn_to(const LyingRing& from, LyingGrip::Of grip, const LyingRing& like,
                       const Camera& camera) {
        return dragged(from, grip, camera, px(from, grip, camera), px(like, grip, camera));
    }
};

TEST_F(LyingTest, FromItsCameraTheRingIsTheEllipseInThePicture) {
    const glm::dvec2 middle(0.6 * 1600.0, 0.6 * 1000.0);
    const double radius = 0.36 * 1000.0;
    const glm::dvec2 major(std::sqrt(0.75), -0.5), minor(-0.5, -std::sqrt(0.75));
    for (const double degrees : {0.0, 50.0, 90.0, 180.0, 270.0}) {
        const double t = degrees * std::numbers::pi / 180.0;
        const glm::dvec2 expected = middle + radius * (std::cos(t) * major + 0.5 * std::sin(t) * minor);
        EXPECT_LT(glm::distance(expected, glm::dvec2(*project_point(front, point_on(ring(), degrees)))), 0.2)
            << degrees;
    }
    EXPECT_GT(point_on(ring(), 90.0).y, 1.0) << "nearer to the camera";
    EXPECT_LT(point_on(ring(), 270.0).y, -1.0);
}

TEST_F(LyingTest, EndsOfTheMinorAxisAreItsInclination) {
    for (const double wanted : {0.0, 23.4, 60.0, 85.0}) {
        LyingRing like = ring();
        like.inclination = wanted;
        for (const Of grip : {Of::minor, Of::minor_far})
            EXPECT_NEAR(drawn_to(ring(), grip, like, front).inclination, wanted, wanted == 0.0 ? 3.0 : 0.2);
    }
    EXPECT_EQ(dragged(ring(), Of::minor, front, {500, 500}, {500, 500}), ring()) << "where it is taken";
}

TEST_F(LyingTest, EndsOfTheMajorAxisTurnItWithItsNearSide) {
    LyingRing like = ring();
    like.near_deg = 100.0;
    for (const Of grip : {Of::major, Of::major_other}) {
        const std::vector<NewValue> values = changed_values(ring(), drawn_to(ring(), grip, like, front));
        ASSERT_EQ(values.size(), 2u);
        EXPECT_EQ(values[0].key, "layer.m77.source.structure.position_angle");
        EXPECT_NEAR(values[0].value.number(), 10.0, 0.11);
        EXPECT_EQ(values[1].key, "layer.m77.source.structure.near_side");
        EXPECT_NEAR(values[1].value.number(), 100.0, 0.11);
    }
}

TEST_F(LyingTest, TheMarkGoesToTheOtherSideAlone) {
    const glm::dvec2 near = px(ring(), Of::near, front), far = px(ring(), Of::far, front);
    EXPECT_EQ(dragged(ring(), Of::near, front, near, near + 0.3 * (far - near)), ring());
    const std::vector<NewValue> values =
        changed_values(ring(), dragged(ring(), Of::near, front, near, near + 0.7 * (far - near)));
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].key, "layer.m77.source.structure.near_side");
    EXPECT_EQ(values[0].value.number(), 300.0);
}

TEST_F(LyingTest, FromAsideTheRingIsTurnedToo) {
    CameraParams params = scene.camera;
    params.position = glm::dvec3(15.0, 15.0, 4.0);
    const Camera aside = make_camera(params, 1600.0, 1000.0, {});
    LyingRing like = ring();
    like.inclination = 35.0;
    EXPECT_NEAR(drawn_to(ring(), Of::minor, like, aside).inclination, 35.0, 0.2);
    like = ring();
    like.near_deg = 150.0;
    EXPECT_NEAR(drawn_to(ring(), Of::major, like, aside).near_deg, 150.0, 0.2);
}

TEST_F(LyingTest, OfSeveralGalaxiesEachHasOne) {
    const GalaxyParams one = structure().galaxy;
    structure().galaxies = {one, one};
    structure().galaxies[1].center = glm::dvec2(0.8, 0.2);
    structure().galaxies[1].near_side = 300.0;
    ASSERT_EQ(rings().size(), 2u);
    EXPECT_EQ(rings()[1].key, "layer.m77.source.structure.galaxies.1");
    EXPECT_EQ(rings()[1].near_deg, -60.0);
    EXPECT_EQ(grip_at(front, rings(), px(rings()[1], Of::major, front) + 3.0, 9.0),
              (LyingGrip{Of::major, 1}));
    structure().galaxies[0].center.reset();
    EXPECT_EQ(rings().size(), 1u) << "it is not known where";
}

TEST_F(LyingTest, AnAxisHasItsEquator) {
    structure().kind = StructureKind::axis;
    EXPECT_TRUE(rings().empty());
    structure().axis_angle = 70.0;
    structure().tilt = 20.0;
    ASSERT_EQ(rings().size(), 1u);
    const LyingRing equator = ring();
    EXPECT_EQ(grips_of(front, equator).size(), 4u) << "no marks";
    const glm::dvec2 end = glm::dvec2(*project_point(front, axis_end(equator))) - glm::dvec2(800.0, 500.0);
    EXPECT_NEAR(std::atan2(-end.y, end.x) * 180.0 / std::numbers::pi, 70.0, 0.1);
    EXPECT_GT(axis_end(equator).y, 0.5) << "it leans towards the camera";
    LyingRing like = equator;
    like.inclination = 90.0 - -35.0;
    std::vector<NewValue> values = changed_values(equator, drawn_to(equator, Of::minor, like, front));
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].key, "layer.m77.source.structure.tilt");
    EXPECT_NEAR(values[0].value.number(), -35.0, 0.2);
    like = equator;
    like.near_deg += 40.0;
    values = changed_values(equator, drawn_to(equator, Of::major, like, front));
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].key, "layer.m77.source.structure.axis_angle");
    EXPECT_NEAR(values[0].value.number(), 110.0, 0.2);
}

TEST_F(LyingTest, APictureThatLiesOtherwiseHasNone) {
    structure().kind = StructureKind::sheet;
    EXPECT_TRUE(rings().empty());
    structure().kind = StructureKind::disk;
    EXPECT_EQ(rings().size(), 1u);
    scene.layers[0].source.uv = UvMode::planar_xz;
    EXPECT_TRUE(rings().empty());
    EXPECT_TRUE(lying_rings(scene, 1).empty());
}

}  // namespace
}  // namespace astrosplat
