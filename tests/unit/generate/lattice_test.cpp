// Lattices, and the volume near a mesh that they fill.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "generate/lattice.h"
#include "support/errors.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

// Lattices: names and places of positions, jitter, the choice of voxels, and its messages.

using glm::dvec3;
using glm::i64vec3;

Lattice small_lattice() {
    Lattice lattice;
    lattice.box.lo = dvec3(-1, 0, 10);
    lattice.box.hi = dvec3(1, 3, 14);
    lattice.n = i64vec3(2, 3, 4);
    return lattice;
}

std::vector<TexturedMesh> one_plane() { return {test::textured(builtin_mesh("plane", 2.0))}; }

std::string message(const SourceParams& source, double max_distance = 0.1) {
    return ERROR_OF(make_lattice(source, one_plane(), max_distance));
}

TEST(Lattice, PositionsById) {
    const Lattice lattice = small_lattice();
    EXPECT_EQ(lattice.corners(), 3 * 4 * 5);
    EXPECT_EQ(lattice.positions(), 60 + 24);
    EXPECT_EQ(lattice_position(lattice, 0), dvec3(-1, 0, 10));
    EXPECT_EQ(lattice_position(lattice, 1), dvec3(0, 0, 10));
    EXPECT_EQ(lattice_position(lattice, 3), dvec3(-1, 1, 10));
    EXPECT_EQ(lattice_position(lattice, 12), dvec3(-1, 0, 11));
    EXPECT_EQ(lattice_position(lattice, 59), dvec3(1, 3, 14));
    EXPECT_EQ(lattice_position(lattice, 60), dvec3(-0.5, 0.5, 10.5));
    EXPECT_EQ(lattice_position(lattice, 83), dvec3(0.5, 2.5, 13.5));
    EXPECT_EQ(corner_id(lattice, {1, 2, 3}), (3u * 4u + 2u) * 3u + 1u);
    EXPECT_EQ(centre_id(lattice, {1, 2, 3}), 60u + (3u * 3u + 2u) * 2u + 1u);
}

TEST(Lattice, JitterFillsHalfAVoxelAndNoMore) {
    const Lattice lattice = small_lattice();
    for (const double jitter : {0.0, 0.25, 1.0}) {
        double largest = 0.0, sum = 0.0;
        for (std::uint32_t seed = 1; seed <= 100; ++seed) {
            for (std::uint64_t id = 0; id < 84; ++id) {
                const dvec3 moved =
                    jittered_position(lattice, id, jitter, seed) - lattice_position(lattice, id);
                for (int axis = 0; axis < 3; ++axis) {
                    const double share = moved[axis] / (0.5 * lattice.spacing()[axis]);
                    largest = std::max(largest, std::fabs(share));
                    sum += share;
                }
            }
        }
        EXPECT_LE(largest, jitter * (1.0 + 1e-12));
        EXPECT_GE(largest, jitter * 0.999);
        EXPECT_NEAR(sum / 25200.0, 0.0,
                    jitter * 4.0 * std::sqrt(1.0 / 3.0 / 25200.0));  // four standard deviations
    }
}

TEST(Lattice, SeedsComeFromNamesAndAreNeverZero) {
    EXPECT_EQ(resolved_seed(7, "stars"), 7u);
    EXPECT_NE(resolved_seed(0, "stars"), resolved_seed(0, "dust"));
    EXPECT_NE(resolved_seed(0, "ab"), resolved_seed(0, "ba"));
    EXPECT_EQ(resolved_seed(0, "stars"), resolved_seed(0, "stars"));
    std::set<std::uint32_t> seeds;
    for (int i = 0; i < 1000; ++i) seeds.insert(resolved_seed(0, std::to_string(i)));
    EXPECT_EQ(seeds.size(), 1000u);
    EXPECT_EQ(seeds.count(0), 0u);
}

TEST(Lattice, MaxDistanceZeroIsTwoPercentOfTheLongestSide) {
    SourceParams source;
    EXPECT_DOUBLE_EQ(resolved_max_distance(source, bounds(one_plane())), 0.2);
    source.max_distance = 0.7;
    EXPECT_EQ(resolved_max_distance(source, bounds(one_plane())), 0.7);
    source.max_distance = -1.0;
    EXPECT_THROW(resolved_max_distance(source, bounds(one_plane())), InputError);
}

TEST(Lattice, BufferGrowsTheBoxOnBothSides) {
    SourceParams source;
    source.voxels = i64vec3(10, 2, 5);
    const Lattice automatic = make_lattice(source, one_plane(), 0.5);
    EXPECT_EQ(automatic.box.lo, dvec3(-5.5, -0.5, -3.0));
    EXPECT_EQ(automatic.box.hi, dvec3(5.5, 0.5, 3.0));
    EXPECT_EQ(automatic.n, i64vec3(10, 2, 5));
    source.buffer = dvec3(1, 2, 3);
    EXPECT_EQ(make_lattice(source, one_plane(), 0.5).box.hi, dvec3(6, 2, 5.5));
}

TEST(Lattice, VoxelSizeGrowsTheBoxEvenly) {
    SourceParams source;
    source.voxel_size = 0.4;  // the box is 11 x 1 x 6: 27.5, 2.5 and 15 voxels
    const Lattice lattice = make_lattice(source, one_plane(), 0.5);
    EXPECT_EQ(lattice.n, i64vec3(28, 3, 15));
    EXPECT_NEAR(lattice.box.lo.x, -5.6, 1e-12);
    EXPECT_NEAR(lattice.box.hi.x, 5.6, 1e-12);
    EXPECT_NEAR(lattice.box.hi.y, 0.6, 1e-12);
    EXPECT_NEAR(lattice.box.hi.z, 3.0, 1e-12);
    source.voxel_size = 100.0;
    EXPECT_EQ(make_lattice(source, one_plane(), 0.5).n, i64vec3(1, 1, 1));
}

TEST(Lattice, FlatBoxesHaveOneVoxel) {
    SourceParams source;
    source.buffer = dvec3(0.0);
    source.voxel_size = 0.5;
    EXPECT_EQ(make_lattice(source, one_plane(), 0.5).n, i64vec3(20, 1, 10));
}

TEST(Lattice, AutomaticVoxelsFollowTheFormula) {
    SourceParams source;
    source.count = 4000;
    const Lattice lattice = make_lattice(source, one_plane(), 0.2);  // edge^3 = 4 * 50 * 0.2 / 4000 = 0.01
    EXPECT_NEAR(lattice.spacing().x, std::cbrt(0.01), 1e-12);
    EXPECT_NEAR(lattice.spacing().y, std::cbrt(0.01), 1e-12);
    EXPECT_NEAR(expected_kept(lattice, one_plane(), 0.2), 4000.0, 1e-6);
}

TEST(LatticeErrors, OneLineEach) {
    SourceParams source;
    source.voxels = i64vec3(10, 0, 10);
    EXPECT_EQ(message(source), "source.voxels: expected at least 1 per axis, found 0");
    source.voxels = i64vec3(1'000'000'000'000, 1'000'000'000'000, 1);
    EXPECT_EQ(
        message(source),
        "source.voxels: expected a lattice of fewer than 2^62 positions, found 1e+12 x 1e+12 x 1 voxels");
    source.voxels = i64vec3(std::numeric_limits<std::int64_t>::max());
    EXPECT_HAS(message(source), "fewer than 2^62");
    source.voxels.reset();
    source.voxel_size = -0.5;
    EXPECT_EQ(message(source), "source.voxel_size: expected a number above 0, found -0.5");
    source.voxel_size = 1e-200;
    EXPECT_HAS(message(source), "source.voxel_size: expected a lattice of fewer than 2^62");
    source.voxel_size = 0.0;
    source.count = 0;
    EXPECT_EQ(message(source), "source.count: expected at least 1, found 0");
    source.count = std::numeric_limits<std::int64_t>::max();
    EXPECT_HAS(message(source), "source.count: expected a lattice of fewer than 2^62");
    source.count = 1000;
    source.buffer = dvec3(1, -1, 1);
    EXPECT_EQ(message(source), "source.buffer: expected numbers of at least 0, found -1");
}

TEST(LatticeErrors, AutomaticVoxelsNeedAnArea) {
    std::vector<TexturedMesh> meshes = one_plane();
    meshes[0].mesh.triangles = {{{0, 0, 0}, {0, 0, 0}, 0}};
    EXPECT_EQ(ERROR_OF(make_lattice(SourceParams(), meshes, 0.1)),
              "source.voxels: expected numbers, because the meshes have no area to choose them by, "
              "found \"auto\"");
}

// The volume near meshes, by Steiner's formula: flat convex meshes of area A and perimeter P have
// 2 A d + pi/2 P d^2 + 4/3 pi d^3 within d. And that `count` and `splats` are kept, on any mesh.

using real::pi;
using test::flat_texture;
using test::textured;

double steiner(double width, double depth, double d) {
    return 2.0 * width * depth * d + pi / 2.0 * 2.0 * (width + depth) * d * d + 4.0 / 3.0 * pi * d * d * d;
}

Texture half_texture() { return test::half_lit(glm::vec4(1.0f)); }

std::vector<TexturedMesh> rectangle(double width, double depth, Texture texture) {
    Mesh mesh = builtin_mesh("plane", 1.0);
    for (glm::vec3& p : mesh.positions) p = glm::vec3(dvec3(p) * dvec3(width / 10.0, 1.0, depth / 10.0));
    return {textured(std::move(mesh), std::move(texture))};
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
    EXPECT_EQ(ERROR_OF(make_lattice(source, rectangle(10, 10, flat_texture({1, 1, 1, 0})), 0.2)),
              "source.splats: expected a picture and masks that leave something, found nothing that "
              "is not transparent");
}

}  // namespace
}  // namespace astrosplat
