// What is drawn around in a view, as a crop has it, and what becomes of it.
#include "edit/selection.h"

#include <glm/geometric.hpp>

#include "core/rotation.h"
#include "look/prepare.h"
#include "scene/load.h"
#include "support/test.h"
#include "unit/edit/scenes.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

using Points = std::vector<glm::dvec2>;

TEST(Simplified, KeepsWhatShowsAndNoMore) {
    const Points line{{0, 0}, {1, 0.1}, {2, 0}, {3, 4}, {4, 8.2}, {5, 12}, {5, 12}};
    EXPECT_EQ(simplified(line, 0.5), (Points{{0, 0}, {2, 0}, {5, 12}}));
    EXPECT_EQ(simplified(line, 0.05), (Points{{0, 0}, {1, 0.1}, {2, 0}, {5, 12}}));
    EXPECT_EQ(simplified(Points{{3, 4}}, 0.5), (Points{{3, 4}, {3, 4}})) << "a dab";
}

float distance_to(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 along = b - a;
    const double t = std::clamp(glm::dot(p - a, along) / std::max(1e-12, glm::dot(along, along)), 0.0, 1.0);
    return float(glm::distance(p, a + t * along));
}

struct Relation {
    bool inside = false;
    double from_edge = 1e9;  // px
};

Relation relation(const glm::dvec2& p, const DrawnLine& line) {
    Relation result;
    const bool closed = line.radius == 0.0;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < line.points.size(); ++i) {
        const glm::dvec2 &a = line.points[i], &b = line.points[(i + 1) % line.points.size()];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
            result.inside = !result.inside;
        result.from_edge = std::min(result.from_edge, double(distance_to(p, a, b)));
    }
    if (closed) return result;
    return {result.from_edge < line.radius, std::fabs(result.from_edge - line.radius)};
}

/// Through every lens, of a layer that is moved, turned and scaled: what is kept is what is seen within the
/// line.
TEST(CropBehind, IsWhatIsSeenWithinTheLine) {
    const LayerPlacement placement{rotation_from_degrees({20.0, -35.0, 50.0}), 1.7, {0.3, -0.2, 0.5}};
    const DrawnLine lasso{{{150, 90}, {330, 120}, {410, 260}, {260, 210}, {220, 330}}};
    const DrawnLine stroke{{{270, 230}, {320, 180}, {360, 200}}, 20.0};
    const SplatSet set = test::one_splat(0.0f, 1.0f, 1.0f);
    for (std::size_t lens = 0; lens < names_of(Projection()).size(); ++lens) {
        CameraParams params;
        params.projection = Projection(lens);
        const std::string_view name = name_of(params.projection);
        params.position = glm::dvec3(1.0, 2.0, 9.0);
        params.target = {0.5, 0.0, 0.0};
        params.roll = 10.0;
        params.height = 8.0;
        params.panorama_fov = 150.0;
        params.fisheye_fov = 100.0;
        if (params.projection == Projection::perspective) params.shift = {0.1, -0.05};
        const Camera camera = make_camera(params, 640.0, 360.0, {});
        for (const DrawnLine& line : {lasso, stroke}) {
            const std::optional<Crop> crop = crop_behind(camera, placement, line);
            ASSERT_TRUE(crop) << name;
            Look look;
            look.crop = {*crop};
            const PreparedLook prepared = prepare_look(set, look, {});
            int inside = 0;
            for (std::int64_t i = 0; i < 4000; ++i) {
                const glm::dvec2 seen{640.0 * double(test::uniform(i, 1)),
                                      360.0 * double(test::uniform(i, 2))};
                const ViewRay ray = ray_through(camera, seen);
                const double depth = 0.5 + 20.0 * double(test::uniform(i, 3));
                const glm::vec3 place(to_layer(placement, ray.origin + depth * ray.direction));
                const Relation expected = relation(seen, line);
                // Where the frame is not flat as an outline is a brush gets oval beside its middle.
                const double unsure = line.radius > 0.0 && is_onto_sphere(params.projection) ? 2.5 : 0.6;
                if (expected.from_edge < unsure) continue;
                inside += expected.inside ? 1 : 0;
                ASSERT_EQ(outlined(prepared, place), expected.inside ? 1.0f : 0.0f)
                    << name << " at " << seen.x << " " << seen.y << " depth " << depth << " of "
                    << crop->outline;
            }
            EXPECT_GT(inside, 100) << name;
        }
    }
}

Camera camera_before() {
    CameraParams params;
    params.position = glm::dvec3(0.0, 0.0, 9.0);
    return make_camera(params, 640.0, 360.0, {});
}

TEST(CropBehind, NothingIsNoCrop) {
    const Camera camera = camera_before();
    EXPECT_FALSE(crop_behind(camera, {}, {{{10, 10}}})) << "a click";
    EXPECT_FALSE(crop_behind(camera, {}, {{{10, 10}, {90, 90}, {10.4, 10.4}}})) << "to and fro";
    EXPECT_TRUE(crop_behind(camera, {}, {{{10, 10}}, 5.0})) << "a dab of the brush";
    CameraParams dome;
    dome.projection = Projection::fisheye;
    dome.position = glm::dvec3(0.0, 0.0, 9.0);
    const Camera all_round = make_camera(dome, 400.0, 400.0, {});
    EXPECT_FALSE(crop_behind(all_round, {}, {{{5, 200}, {200, 5}, {395, 200}, {200, 395}}})) << "half a sky";
    EXPECT_TRUE(crop_behind(all_round, {}, {{{5, 200}, {40, 150}, {60, 250}}})) << "at its rim";
}

TEST(CropBehind, FeathersByPixelsOfTheLayersMiddle) {
    const Camera camera = camera_before();
    const LayerPlacement placement{glm::dmat3(1.0), 2.0, {0.0, 0.0, 1.0}};
    DrawnLine line{{{100, 100}, {200, 100}, {150, 200}}, 0.0, 10.0};
    const float soft = crop_behind(camera, placement, line)->soft;
    EXPECT_NEAR(soft, 10.0 * units_per_px(camera, {0.0, 0.0, 1.0}) / 2.0, 1e-3);
}

struct SelectPart : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");
    Camera camera = make_camera(scene.camera, 640.0, 360.0, {});
    Crop stroke(double x) const { return *crop_behind(camera, {}, {{{x, 50}, {x, 90}}, 8.0}); }
    Crop lasso() const { return *crop_behind(camera, {}, {{{10, 10}, {90, 10}, {90, 90}}}); }
    const std::vector<Crop>& crops(std::size_t layer) const { return scene.layers.at(layer).look.crop; }
};

TEST_F(SelectPart, StrokesOfOneViewAreOneCrop) {
    for (const double x : {100.0, 200.0, 300.0}) select_part(scene, 0, stroke(x), SelectionFate::erase);
    ASSERT_EQ(crops(0).size(), 1u);
    EXPECT_EQ(crops(0)[0].keep, Crop::Keep::outside);
    EXPECT_EQ(outline_lines(crops(0)[0].outline).size(), 3u);
    select_part(scene, 0, stroke(400.0), SelectionFate::keep);
    EXPECT_EQ(crops(0).size(), 2u) << "the other fate";
    camera.eye.x += 1.0;
    select_part(scene, 0, stroke(400.0), SelectionFate::keep);
    EXPECT_EQ(crops(0).size(), 3u) << "another view";
    select_part(scene, 0, lasso(), SelectionFate::erase);
    select_part(scene, 0, lasso(), SelectionFate::erase);
    EXPECT_EQ(crops(0).size(), 5u) << "polygons would be holes of each other";
    forget_outlines(scene, 0);
    EXPECT_TRUE(crops(0).empty());
}

/// Every splat is in the one or in the other: they have one seed, and the same outline.
TEST_F(SelectPart, APartIsALayerOfTheSameSplats) {
    EXPECT_EQ(select_part(scene, 0, stroke(100.0), SelectionFate::part), 1u);
    ASSERT_EQ(scene.layers.size(), 3u);
    EXPECT_EQ(scene.layers[1].name, "dust_2");
    EXPECT_EQ(select_part(scene, 0, stroke(200.0), SelectionFate::part), 1u) << "more of the same part";
    ASSERT_EQ(scene.layers.size(), 3u);
    EXPECT_NE(scene.layers[0].source.seed, 0u);
    EXPECT_EQ(scene.layers[1].source.seed, scene.layers[0].source.seed);
    EXPECT_EQ(crops(0).back().outline, crops(1).back().outline);
    const SplatSet set = test::one_splat(0.0f, 1.0f, 1.0f);
    scene.layers[0].look.thickness = scene.layers[1].look.thickness = {};
    const PreparedLook whole = prepare_look(set, scene.layers[0].look, {});
    const PreparedLook part = prepare_look(set, scene.layers[1].look, {});
    int in_part = 0;
    for (std::int64_t i = 0; i < 2000; ++i) {
        const glm::vec3 place{8.0f * test::uniform(i, 1) - 4.0f, 4.0f * test::uniform(i, 2) - 1.0f,
                              test::uniform(i, 3)};
        ASSERT_EQ(outlined(whole, place) + outlined(part, place), 1.0f);
        in_part += outlined(part, place) == 1.0f ? 1 : 0;
    }
    EXPECT_GT(in_part, 10);
    EXPECT_EQ(select_part(scene, 0, lasso(), SelectionFate::part), 1u);
    EXPECT_EQ(scene.layers.size(), 4u) << "another part";
}

TEST_F(SelectPart, OneTooManyIsRefusedAndNothingChanges) {
    Document document = Document::untitled(test::edit_scene, "/scene.toml");
    const auto erase = [&] {
        document.edit("Erase", [&](Scene& s) { select_part(s, 0, lasso(), SelectionFate::erase); });
    };
    for (std::size_t i = 0; i < most_outlines; ++i) erase();
    const Scene before = document.scene();
    const std::string said = ERROR_OF(erase());
    EXPECT_NE(said.find("look.crop.64.shape: expected at most 64 outlines, found more"), std::string::npos)
        << said;
    EXPECT_EQ(document.scene(), before);
}

TEST_F(SelectPart, IsSavedAndReadAgain) {
    const TempFolder folder;
    Document document = Document::untitled(test::edit_scene, folder / "untitled.toml");
    document.edit("Erase", [&](Scene& s) { select_part(s, 0, stroke(100.0), SelectionFate::erase); });
    document.edit("Part", [&](Scene& s) { select_part(s, 0, lasso(), SelectionFate::part); });
    document.save_as(folder / "scene.toml");
    const Scene again = load_scene(folder / "scene.toml");
    ASSERT_EQ(again.layers.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(again.layers[i].look.crop, document.scene().layers[i].look.crop) << i;
}

}  // namespace
}  // namespace astrosplat
