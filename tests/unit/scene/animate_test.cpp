// The scene at one frame, and what the renderer takes of it.
#include "scene/animate.h"
#include "scene/check.h"
#include "scene/layer_setup.h"
#include "scene/load.h"
#include "scene_texts.h"
#include "support/test.h"

namespace astrosplat::test {
namespace {

Scene animated(const std::string& tracks, const std::string& layer = "") {
    return parse(small_scene(layer) + "[animation]\n" + tracks);
}

TEST(Animate, LinearNumbersAndHeldEnds) {
    const Scene scene = animated("\"layer.stars.render.core\" = { keys = [[1, 1.0], [121, 0.5]] }\n");
    EXPECT_EQ(scene_at(scene, -10).layers[0].render.falloff.core, 1.0f);
    EXPECT_EQ(scene_at(scene, 61).layers[0].render.falloff.core, 0.75f);
    EXPECT_EQ(scene_at(scene, 500).layers[0].render.falloff.core, 0.5f);
    EXPECT_EQ(scene_at(scene, 31).layers[0].render.falloff.core, 0.875f);
}

TEST(Animate, ChoicesBooleansAndIntegersStep) {
    const Scene scene = animated(
        "\"layer.stars.render.blend\" = { keys = [[1, \"over\"], [5, \"hybrid\"]] }\n"
        "\"layer.stars.visible\" = { keys = [[1, true], [3, false], [9, true]], interpolation = \"smooth\" "
        "}\n"
        "\"layer.stars.look.noise.octaves\" = { keys = [[1, 2], [5, 9]] }\n");
    const Scene before = scene_at(scene, 4.99), after = scene_at(scene, 5);
    EXPECT_EQ(before.layers[0].render.blend, Blend::over);
    EXPECT_EQ(after.layers[0].render.blend, Blend::hybrid);
    EXPECT_EQ(before.layers[0].look.noise[0].octaves, 2);
    EXPECT_EQ(after.layers[0].look.noise[0].octaves, 9);
    EXPECT_TRUE(scene_at(scene, 2).layers[0].visible);
    EXPECT_FALSE(scene_at(scene, 3).layers[0].visible);
    EXPECT_FALSE(scene_at(scene, 8).layers[0].visible);
    EXPECT_TRUE(scene_at(scene, 9).layers[0].visible);
}

TEST(Animate, SmoothNeverLeavesTheRangeOfItsKeyframes) {
    const Scene scene = animated(
        "\"layer.stars.render.opacity\" = { keys = [[0, 0], [10, 1], [11, 1], [30, 0]], interpolation = "
        "\"smooth\", ends = \"through\" }\n"
        "\"layer.stars.look.grade.tint\" = { keys = [[0, [0, 1, 0.5]], [10, [1, 0, 0.5]]], interpolation = "
        "\"smooth\" }\n");
    for (int i = 0; i <= 300; ++i) {
        const LayerParams layer = scene_at(scene, i * 0.1).layers[0];
        EXPECT_GE(layer.render.opacity, 0.0f);
        EXPECT_LE(layer.render.opacity, 1.0f);
        EXPECT_EQ(layer.look.grade.tint.z, 0.5f);
    }
    EXPECT_EQ(scene_at(scene, 5).layers[0].look.grade.tint.x, 0.5f) << "eased ends: the middle is the middle";
}

TEST(Animate, PositionsAndRotations) {
    const Scene scene = animated(
        "\"camera.position\" = { keys = [[0, [0, 0, 0]], [10, [10, 0, 0]]] }\n"
        "\"camera.rotation\" = { keys = [[0, [0, 0, 0, 2]], [10, [0, 0, 1, 0]]] }\n"
        "\"layer.stars.transform.translate\" = { keys = [[0, [0, 0, 0]], [10, [0, 4, 0]]], constant_speed = "
        "true }\n");
    const Scene still = scene_at(scene, 5);
    EXPECT_EQ(still.camera.position, glm::dvec3(5, 0, 0));
    EXPECT_NEAR(still.layers[0].transform.translate.y, 2.0, 1e-9);
    ASSERT_TRUE(still.camera.rotation);
    const double half = 0.70710678118654752;  // a quarter turn about z of the half turn between the keys
    EXPECT_NEAR(still.camera.rotation->z, half, 1e-12);
    EXPECT_NEAR(still.camera.rotation->w, half, 1e-12);
}

// Keys at uneven frames: only at constant speed is half of the time half of the way.
TEST(Animate, ConstantSpeedIsOfTheTrack) {
    const std::string keys = "keys = [[0, [0, 0, 0]], [9, [1, 0, 0]], [10, [10, 0, 0]]]";
    const Scene even = animated("\"camera.position\" = { " + keys + ", constant_speed = true }\n");
    const Scene uneven = animated("\"camera.position\" = { " + keys + " }\n");
    EXPECT_NEAR(scene_at(even, 5).camera.position->x, 5.0, 1e-9);
    EXPECT_NEAR(scene_at(uneven, 4.5).camera.position->x, 0.5, 1e-9);
}

TEST(Animate, CurvesAndListElements) {
    const Scene scene = animated(
        "\"layer.stars.look.pdf.points\" = { keys = [[0, [[0, 1], [1, 0]]], [10, [[0, 0], [0.5, 1]]]] }\n"
        "\"layer.stars.look.thickness.keys.0.scale\" = { keys = [[0, 1], [10, 3]] }\n");
    const Look look = scene_at(scene, 5).layers[0].look;
    ASSERT_EQ(look.pdf.points.size(), 2u);
    EXPECT_EQ(look.pdf.points[0], glm::vec2(0.0f, 0.5f));
    EXPECT_EQ(look.pdf.points[1], glm::vec2(0.75f, 0.5f));
    EXPECT_EQ(look.thickness.stops.at(0).scale, 2.0f);
}

TEST(Animate, EveryAnimatableParameterHoldsItsKey) {
    Scene scene = parse(full_scene());
    int animated_parameters = 0;
    for (const Parameter& parameter : describe(scene).parameters) {
        const Value value = parameter.get();
        const std::vector<double> numbers = to_numbers(parameter.spec, value);
        if (parameter.spec.animation == Animation::no || numbers.empty()) continue;
        ++animated_parameters;
        Scene one = scene;
        one.animation = {{parameter.spec.key, {{1.0, numbers, Interpolation::linear}}}};
        const Scene still = scene_at(one, 7.0);
        EXPECT_EQ(still, one) << parameter.spec.key;
    }
    EXPECT_GT(animated_parameters, 60);
}

// From keys to what the renderer and the look take: stars.

Scene star_scene(const std::string& source, const std::string& rest = "") {
    return parse_scene(
        "astrosplat = 1\n[[layer]]\nname = \"sky\"\n[layer.source]\nkind = \"stars\"\n"
        "catalogue = \"a.csv\"\n" +
            source + "\n" + rest,
        "a.toml");
}

TEST(LayerSetup, StarsHaveTheImageThatTheKeysSay) {
    const Scene scene = star_scene(
        "psf = 1.5\nwings = { share = 0.25, px = 4, power = 3 }\n"
        "spikes = { share = 0.125, vanes = 3, angle = 15, px = 50 }");
    const std::optional<StarPsf> psf = render_layer(scene.layers[0]).stars;
    EXPECT_EQ(psf, (StarPsf{1.5f, 0.25f, 4.0f, 3.0f, 0.125f, 3, 15.0f, 50.0f}));
    EXPECT_EQ(render_layer(star_scene("").layers[0]).stars, StarPsf());
    EXPECT_FALSE(render_layer(LayerParams()).stars);
}

TEST(LayerSetup, TheImageOfStarsMayMove) {
    const Scene scene = star_scene("spikes.share = 0.5",
                                   "[animation]\n\"layer.sky.source.psf\" = { keys = [[1, 1], [3, 2]] }\n"
                                   "\"layer.sky.source.wings.share\" = { keys = [[1, 0], [3, 1]] }\n");
    const std::optional<StarPsf> psf = render_layer(scene_at(scene, 2.5).layers[0]).stars;
    ASSERT_TRUE(psf);
    EXPECT_EQ(psf->core_px, 1.75f);
    EXPECT_EQ(psf->wing_share, 0.75f);
    EXPECT_EQ(psf->spike_share, 0.25f);  // no more light than there is
}

TEST(LayerSource, StarsAlongTheCameraHaveItsPath) {
    const Scene still = star_scene("along = \"camera\"", "[camera]\nposition = [1, 2, 3]\n");
    EXPECT_EQ(source_of(still, still.layers[0]).stars.path, (std::vector{glm::dvec3(1, 2, 3)}));
    const Scene moving =
        star_scene("along = \"camera\"",
                   "[animation]\n\"camera.position\" = { keys = [[1, [0, 0, 0]], [9, [90, 0, 0]], "
                   "[20, [90, 40, 0]]] }\n");
    EXPECT_EQ(source_of(moving, moving.layers[0]).stars.path,
              (std::vector{glm::dvec3(0, 0, 0), glm::dvec3(90, 0, 0), glm::dvec3(90, 40, 0)}));
    const Scene catalogue = star_scene("", "[camera]\nposition = [1, 2, 3]\n");
    EXPECT_TRUE(source_of(catalogue, catalogue.layers[0]).stars.path.empty());
}

TEST(LayerSource, StarsAlongACameraWithoutAPlaceCannotBeRendered) {
    const Scene lost = star_scene("along = \"camera\"");
    EXPECT_EQ(
        ERROR_OF(check_renderable(lost, {{"layer.sky.source.along", "a.toml:7"}})),
        "a.toml:7: layer.sky.source.along: expected camera.position, or keyframes of it, for stars along the "
        "camera, found none");
    EXPECT_EQ(
        ERROR_OF(check_renderable(star_scene("along = \"camera\"", "[camera]\nposition = [1, 2, 3]\n"), {})),
        "no error");
}

TEST(LayerSetup, OfALookStarsTakeTheGradeAlone) {
    LayerParams layer;
    layer.look.density = 0.5f;
    layer.look.radius.max = 3.0f;
    layer.look.thickness.map = "a.png";
    layer.look.grade.gain = 2.0f;
    EXPECT_EQ(look_of(layer), layer.look);
    layer.source.kind = SourceKind::stars;
    Look expected;
    expected.grade.gain = 2.0f;
    EXPECT_EQ(look_of(layer), expected);
}

}  // namespace
}  // namespace astrosplat::test
