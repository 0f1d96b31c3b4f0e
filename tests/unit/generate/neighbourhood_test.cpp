// The volume near meshes, by Steiner's formula: flat convex meshes of area A and perimeter P have
// 2 A d + pi/2 P d^2 + 4/3 pi d^3 within d. And that `count` and `splats` are kept, on any mesh.
#include "generate/lattice.h"

#include <cmath>

#include "core/error.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

using glm::dvec3;
using real::pi;
using test::flat_texture;
using test::textured;

double steiner(double width, double depth, double d) {
    return 2.0 * width * depth * d + pi / 2.0 * 2.0 * (width + depth) * d * d + 4.0 / 3.0 * pi * d * d * d;
}

Texture half_texture() {
    Texture texture = flat_texture({1, 1, 1, 1}, 64);
    for (std::int64_t y = 0; y < 64; ++y) std::fill_n(texture.image.at(0, y), 4 * 32, 0.0f);
    return texture;
}

std::vector<TexturedMesh> rectangle(double width, double depth, Texture texture) {
    Mesh mesh = builtin_mesh("plane", 1.0);
    for (glm::vec3& p : mesh.positions) p = glm::vec3(dvec3(p) * dvec3(width / 10.0, 1.0, depth / 10.0));
    std::vector<TexturedMesh> meshes;
    meshes.push_back(textured(std::move(mesh), std::move(texture)));
    return meshes;
}

Neighbourhood measured(const std::vector<TexturedMesh>& meshes, double d) {
    Bounds box = bounds(meshes);
    box.lo -= dvec3(d);
    box.hi += dvec3(d);
    return measure_neighbourhood(meshes, box, d);
}

TEST(Neighbourhood, IsSteinersVolume) {
    for (const dvec3& given : {dvec3(10, 10, 1), dvec3(10, 10, 0.01), dvec3(100, 0.01, 2), dvec3(3, 1, 5)}) {
        const double width = given.x, depth = given.y, d = given.z;
        const double volume = steiner(width, depth, d);
        const Neighbourhood near = measured(rectangle(width, depth, flat_texture({1, 1, 1, 1})), d);
        EXPECT_NEAR(near.volume, volume, 0.02 * volume) << width << " x " << depth << ", " << d;
        EXPECT_EQ(near.lit, near.volume);
    }
}

TEST(Neighbourhood, LitIsThePartBeforeThatIsNotTransparent) {
    const Neighbourhood near = measured(rectangle(10, 10, half_texture()), 0.5);
    EXPECT_NEAR(near.lit / near.volume, 0.5, 0.02);
}

TEST(Neighbourhood, ABoxWithoutRoomIsNothing) {
    const std::vector<TexturedMesh> meshes = rectangle(10, 10, half_texture());
    EXPECT_EQ(measure_neighbourhood(meshes, bounds(meshes), 0.5).volume, 0.0);
}

// Splats, and those that were transparent, of a source's lattice.
struct Kept {
    double splats, positions;
};
Kept kept(const SourceParams& source, const std::vector<TexturedMesh>& meshes) {
    const double d = resolved_max_distance(source, bounds(meshes));
    const SplatSet set = generate(meshes, make_lattice(source, meshes, d), d, 1.0, 3);
    return {static_cast<double>(set.size()), static_cast<double>(set.size() + set.zero_alpha)};
}

TEST(AutomaticVoxels, CountIsKeptOnThinMeshesAndWithStrayVertices) {
    SourceParams source;
    source.count = 100000;
    std::vector<TexturedMesh> strip = rectangle(100, 0.01, flat_texture({1, 1, 1, 1}));
    EXPECT_NEAR(kept(source, strip).positions, 1e5, 0.05 * 1e5);
    std::vector<TexturedMesh> stray = rectangle(2, 2, flat_texture({1, 1, 1, 1}));
    stray[0].mesh.positions.emplace_back(300.0f, 40.0f, 0.0f);
    EXPECT_NEAR(kept(source, stray).positions, 1e5, 0.05 * 1e5);
    source.count = 3000;
    EXPECT_NEAR(kept(source, strip).positions, 3e3, 0.1 * 3e3);
}

TEST(AutomaticVoxels, CountIsOfPositionsAndSplatsOfWhatIsLeftOfThem) {
    SourceParams source;
    source.count = 50000;
    const std::vector<TexturedMesh> half = rectangle(10, 10, half_texture());
    EXPECT_NEAR(kept(source, half).positions, 5e4, 0.15 * 5e4);
    EXPECT_NEAR(kept(source, half).splats, 2.5e4, 0.15 * 2.5e4);
    source.splats = 50000;
    EXPECT_NEAR(kept(source, half).splats, 5e4, 0.03 * 5e4);
}

TEST(AutomaticVoxels, TheAreaDecidesWhereItTellsTheCount) {
    SourceParams source;
    source.count = 40000;
    const std::vector<TexturedMesh> plane = rectangle(10, 10, flat_texture({1, 1, 1, 1}));
    EXPECT_NEAR(make_lattice(source, plane, 0.2).spacing().x, std::cbrt(4.0 * 100.0 * 0.2 / 4e4), 1e-12);
}

TEST(AutomaticVoxels, WhatIsExpectedFollowsTheRoomAndTheTransparency) {
    SourceParams source;
    source.count = 50000;
    for (const auto& meshes :
         {rectangle(100, 0.01, flat_texture({1, 1, 1, 1})), rectangle(10, 10, half_texture())}) {
        const double d = resolved_max_distance(source, bounds(meshes));
        const double expected = expected_kept(make_lattice(source, meshes, d), meshes, d);
        EXPECT_NEAR(kept(source, meshes).splats, expected, 0.15 * expected);
    }
}

TEST(AutomaticVoxels, SplatsOfAnEmptyPictureAreRefused) {
    SourceParams source;
    source.splats = 1000;
    try {
        make_lattice(source, rectangle(10, 10, flat_texture({1, 1, 1, 0})), 0.2);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "source.splats: expected a picture and masks that leave something, found nothing that "
                     "is not transparent");
    }
}

}  // namespace
}  // namespace astrosplat
