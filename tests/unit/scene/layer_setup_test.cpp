// From keys to what the renderer and the look take: stars.
#include "scene/layer_setup.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/animate.h"
#include "scene/check.h"
#include "scene/load.h"
#include "support/errors.h"

namespace astrosplat {
namespace {

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
        message_of<InputError>([&] {
            check_renderable(lost, {{"layer.sky.source.along", "a.toml:7"}});
        }),
        "a.toml:7: layer.sky.source.along: expected camera.position, or keyframes of it, for stars along the "
        "camera, found none");
    EXPECT_EQ(message_of<InputError>([&] {
                  check_renderable(star_scene("along = \"camera\"", "[camera]\nposition = [1, 2, 3]\n"), {});
              }),
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
}  // namespace astrosplat
