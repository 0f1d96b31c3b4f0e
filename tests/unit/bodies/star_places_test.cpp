// Stars of a picture in depth: each on its ray to the picture's camera, and before what would hide it.
#include "bodies/star_places.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "source/mesh.h"

namespace astrosplat {
namespace {

// 10 units wide and 5 high, in xz, its front up.
TexturedMesh plane_with_picture() {
    TexturedMesh mesh;
    mesh.mesh = builtin_mesh("plane", 2.0);
    mesh.textures.emplace_back();
    mesh.textures[0].image = make_image(200, 100, 4, 1.0f);
    return mesh;
}

TEST(StarPlaces, ASlabHoldsTheNearestInFrontAndTheFarthestBehind) {
    const TexturedMesh mesh = plane_with_picture();
    StarDepths depths;
    depths.slab = 2.0;
    const std::array stars{SeenStar{{0.5f, 0.5f}, 0.0f}, SeenStar{{0.25f, 0.75f}, 1.0f},
                           SeenStar{{1.5f, 0.5f}, 0.5f}};
    const PlacedStars placed = place_stars(mesh, stars, depths);
    ASSERT_EQ(placed.star, (std::vector<std::size_t>{0, 1})) << "what the mesh does not show is left out";
    const std::array expected{glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(-2.5f, -1.0f, -1.25f)};
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(placed.position[i][k], expected[i][k], 1e-5f) << i << " " << k;
    EXPECT_NEAR(placed.distance[1], 1.0f, 1e-5f);
    EXPECT_NEAR(placed.texel_side, 0.05, 1e-9);
    EXPECT_EQ(placed.height_texels, 100.0);
    EXPECT_EQ(shown_picture(mesh), &mesh.textures[0]);
    EXPECT_EQ(shown_picture(TexturedMesh{}), nullptr);
}

TEST(StarPlaces, WhatHidesAStarLetsItThroughInFront) {
    const PlacedStars placed =
        place_stars(plane_with_picture(),
                    std::array{SeenStar{{0.5f, 0.5f}, 1.0f}, SeenStar{{0.1f, 0.1f}, 1.0f}}, {2.0, {}, 1});
    ASSERT_EQ(placed.position.size(), 2u);
    std::vector<glm::vec3> position = placed.position;
    SplatSet splats;  // opaque, half a unit wide, before the first star and far from the second
    splats.position = {glm::vec3(0.0f)};
    splats.color = {glm::vec3(1.0f)};
    splats.alpha = {1.0f};
    splats.radius = {0.5f};
    FrontView view;
    view.camera = placed.camera;
    view.height_px = 100.0;
    const std::vector<glm::dvec3> light = passing_light(view, splats, position);
    EXPECT_EQ(light, std::vector<glm::dvec3>(2, glm::dvec3(1.0)));
    EXPECT_GE(position[0].y, 0.0f) << "moved before the splat";
    EXPECT_LT(position[0].y, 0.1f) << "and no farther";
    EXPECT_NEAR(position[0].x, 0.0f, 1e-4f);
    EXPECT_EQ(position[1], placed.position[1]);
}

}  // namespace
}  // namespace astrosplat
