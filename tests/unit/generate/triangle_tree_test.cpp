// The closest triangle: of one, of blocks of positions, and of real meshes.
#include "generate/triangle_tree.h"
#include "generate/lattice.h"
#include "generate/lattice_cull.h"
#include "source/mesh.h"
#include "support/test.h"
#include "support/test_data.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

// The closest point of one triangle in every region, of degenerate triangles, and of meshes.

using glm::dvec3;

// (0,0,0) (4,0,0) (0,3,0): the hypotenuse lies on 3x + 4y = 12, 2.4 from the origin.
ClosestPoint right_triangle(const dvec3& p) {
    return closest_on_triangle(p, {0, 0, 0}, {4, 0, 0}, {0, 3, 0});
}

void expect_closest(const ClosestPoint& c, double distance, double v, double w) {
    EXPECT_DOUBLE_EQ(std::sqrt(c.distance_squared), distance);
    EXPECT_NEAR(c.barycentric.x, v, 1e-15);
    EXPECT_NEAR(c.barycentric.y, w, 1e-15);
}

TEST(ClosestOnTriangle, Corners) {
    expect_closest(right_triangle({-3, -4, 0}), 5.0, 0, 0);
    expect_closest(right_triangle({7, -4, 0}), 5.0, 1, 0);
    expect_closest(right_triangle({0, 15, 5}), 13.0, 0, 1);
}

TEST(ClosestOnTriangle, Edges) {
    expect_closest(right_triangle({1, -3, 4}), 5.0, 0.25, 0);
    expect_closest(right_triangle({-3, 1.5, 4}), 5.0, 0, 0.5);
    expect_closest(right_triangle({2.0 + 3.0, 1.5 + 4.0, 0}), 5.0, 0.5,
                   0.5);  // the hypotenuse's normal is (3, 4)
}

/// To the last bit: what the formula for the inside rounds differently.
TEST(ClosestOnTriangle, OverAnEdgeIsOnTheEdge) {
    const dvec3 a(0, 0, 0), b(0, 1, 0), c(6, 0, 0);
    EXPECT_EQ(closest_on_triangle({5, 0, 2}, a, b, c).barycentric, glm::dvec2(0.0, 30.0 / 36.0));
    EXPECT_EQ(closest_on_triangle({5, 0, 2}, a, c, b).barycentric, glm::dvec2(30.0 / 36.0, 0.0));
}

TEST(ClosestOnTriangle, InsideFromBothSides) {
    expect_closest(right_triangle({1, 1, 2}), 2.0, 0.25, 1.0 / 3.0);
    expect_closest(right_triangle({1, 1, -2}), 2.0, 0.25, 1.0 / 3.0);
    expect_closest(right_triangle({1, 1, 0}), 0.0, 0.25, 1.0 / 3.0);
}

TEST(ClosestOnTriangle, DegenerateTrianglesAreTheirEdges) {
    const dvec3 a(0, 0, 0), b(4, 0, 0), p(3, 4, 0);
    expect_closest(closest_on_triangle({3, 4, 12}, a, a, a), 13.0, 0, 0);
    EXPECT_DOUBLE_EQ(closest_on_triangle(p, a, a, b).distance_squared, 16.0);
    EXPECT_DOUBLE_EQ(closest_on_triangle(p, a, b, a).distance_squared, 16.0);
    EXPECT_DOUBLE_EQ(closest_on_triangle(p, a, b, b).distance_squared, 16.0);
    EXPECT_DOUBLE_EQ(closest_on_triangle(p, a, b, {2, 0, 0}).distance_squared, 16.0);
    EXPECT_DOUBLE_EQ(closest_on_triangle({6, 0, 0}, b, a, {5, 0, 0}).distance_squared, 1.0);
    EXPECT_NEAR(closest_on_triangle(p, a, b, {2, 1e-9, 0}).distance_squared, 16.0 - 4e-9, 1e-14);
}

Mesh square(float size) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {size, 0, 0}, {size, 0, size}, {0, 0, size}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{{0, 1, 2}, {0, 1, 2}, 0}, {{0, 2, 3}, {0, 2, 3}, 0}};
    return mesh;
}

TriangleTree tree_of(const std::vector<Mesh>& meshes) {
    std::vector<const Mesh*> pointers;
    for (const Mesh& mesh : meshes) pointers.push_back(&mesh);
    return make_triangle_tree(pointers);
}

ClosestPoint closest(const TriangleTree& tree, const dvec3& p, double max_distance) {
    return closest_point(tree, p, max_distance).closest;
}

TEST(TriangleTree, TiesGoToTheLowestTriangle) {
    const Mesh one = square(1.0f);
    const TriangleTree tree = tree_of({one, one, one});
    EXPECT_EQ(tree.triangles.size(), 6u);
    EXPECT_EQ(closest(tree, {0.5, 0.25, 0.5}, 1.0).triangle, 0u);  // on the diagonal: six triangles tie
    EXPECT_EQ(closest(tree, {0.2, 0.25, 0.8}, 1.0).triangle, 1u);  // inside the second: three tie
    EXPECT_EQ(closest(tree, {0.5, -0.25, 0.5}, 1.0).triangle, 0u);
    for (std::uint32_t hint = 0; hint < 6; ++hint)
        EXPECT_EQ(closest_point(tree, {0.5, 0.25, 0.5}, 1.0, hint).closest.triangle, 0u);
}

TEST(TriangleTree, MaxDistanceIsInclusive) {
    const TriangleTree tree = tree_of({square(1.0f)});
    EXPECT_EQ(closest(tree, {0.7, 0.25, 0.3}, 0.25).triangle, 0u);
    EXPECT_EQ(closest(tree, {0.7, -0.25, 0.3}, 0.25).triangle, 0u);
    const NearTriangle beyond = closest_point(tree, {0.7, 0.25, 0.3}, std::nextafter(0.25, 0.0));
    EXPECT_EQ(beyond.closest.triangle, ClosestPoint::none);
    EXPECT_EQ(beyond.slot, ClosestPoint::none);
}

TEST(TriangleTree, Sphere) {
    const TriangleTree tree = tree_of({builtin_mesh("sphere", 1.0)});
    for (const double radius : {0.5, 4.0, 4.9, 5.1, 6.0, 20.0}) {
        const dvec3 direction = glm::normalize(dvec3(1.0, radius, -0.3));
        const double distance = std::sqrt(closest(tree, direction * radius, 100.0).distance_squared);
        EXPECT_NEAR(distance, std::fabs(radius - 5.0), 0.01)
            << radius;  // facets cut up to r (1 - cos(half a step))
    }
}

TEST(TriangleTree, NoTriangles) {
    EXPECT_EQ(closest(tree_of({Mesh()}), {0, 0, 0}, 10.0).triangle, ClosestPoint::none);
    EXPECT_EQ(closest(tree_of({}), {0, 0, 0}, 10.0).triangle, ClosestPoint::none);
}

// Each box holds the eight below it, down to the corners; no triangle is lost.
TEST(TriangleTree, BoxesHoldWhatLiesBelowThem) {
    const Mesh mesh = builtin_mesh("sphere", 1.0);
    const TriangleTree tree = tree_of({mesh});
    ASSERT_GT(tree.levels.size(), 2u);
    EXPECT_LE(tree.levels.back().count, TriangleTree::fan);
    std::vector<bool> seen(mesh.triangles.size());
    for (std::size_t slot = 0; slot < tree.triangles.size(); ++slot) {
        const auto& [corners, number, disc] = tree.triangles[slot];
        EXPECT_FALSE(seen[number]);
        seen[number] = true;
        std::size_t box = slot;
        for (const TreeLevel& level : tree.levels) {
            ASSERT_LT(box, level.count);
            for (const glm::vec3& p : {corners.a, corners.b, corners.c}) {
                const dvec3 local = dvec3(p) - tree.origin;
                EXPECT_LE(double(level.lo_x[box]), local.x);
                EXPECT_LE(double(level.lo_y[box]), local.y);
                EXPECT_LE(double(level.lo_z[box]), local.z);
                EXPECT_GE(double(level.hi_x[box]), local.x);
                EXPECT_GE(double(level.hi_y[box]), local.y);
                EXPECT_GE(double(level.hi_z[box]), local.z);
            }
            box /= TriangleTree::fan;
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), std::ptrdiff_t(seen.size()));
}

// Points all around a mesh, also far from the origin, where floats are coarse.
TEST(TriangleTree, EqualsBruteForceWhereverTheMeshLies) {
    for (const double offset : {0.0, 1000.0, 1.0e6}) {
        Mesh mesh = builtin_mesh("sphere", 1.0);
        for (glm::vec3& p : mesh.positions) p = p * 20.0f + float(offset);
        const TriangleTree tree = tree_of({mesh});
        const test::Oracle oracle(mesh);
        std::uint32_t hint = ClosestPoint::none;
        for (std::uint32_t i = 0; i < 300; ++i) {
            const auto random = [&](std::uint32_t axis) {
                return 200.0 * double(shared::as_uniform(shared::as_hash(i, axis, 0, 99))) - 100.0;
            };
            const dvec3 p = offset + dvec3(random(0), random(1), random(2));
            const NearTriangle fast = closest_point(tree, p, 60.0, hint);
            const ClosestPoint slow = oracle.closest(p, 60.0);
            EXPECT_EQ(fast.closest.triangle, slow.triangle) << offset << " " << i;
            EXPECT_EQ(fast.closest.distance_squared, slow.distance_squared) << offset << " " << i;
            EXPECT_EQ(fast.closest.barycentric, slow.barycentric) << offset << " " << i;
            if (slow.triangle != ClosestPoint::none) {
                EXPECT_EQ(tree.triangles[fast.slot].number, slow.triangle);
            }
            hint = i % std::uint32_t(mesh.triangles.size());
        }
    }
}

// Block queries against every triangle, for meshes that bounds could get wrong: needles, points, huge beside
// tiny triangles, few triangles, very many, far from the origin; on every instruction set.

float random(std::uint32_t n, std::uint32_t purpose) {
    return 2.0f * shared::as_uniform(shared::as_hash(7, n, 0, purpose)) - 1.0f;
}

glm::vec3 random_point(std::uint32_t n, std::uint32_t purpose) {
    return {random(n, purpose), random(n, purpose + 1), random(n, purpose + 2)};
}

/// Triangles of sizes 2^-8 to 1 around the origin; every fourth a needle, a line, a point or a copy.
Mesh soup(std::uint32_t count) {
    Mesh mesh;
    for (std::uint32_t n = 0; n < count; ++n) {
        const glm::vec3 a = random_point(n, 100);
        const float size = 1.0f / float(1u << n % 9);
        glm::vec3 b = a + size * random_point(n, 110), c = a + size * random_point(n, 120);
        if (n % 16 == 3) c = a + (b - a) * 0.3f + glm::vec3(0, 1e-6f, 0);
        if (n % 16 == 7) c = a + (b - a) * 0.5f;
        if (n % 16 == 11) b = c = a;
        const auto first = std::uint32_t(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c});
        mesh.triangles.push_back({{first, first + 1, first + 2}, {}});
        if (n % 16 == 15) mesh.triangles.push_back(mesh.triangles[n / 2]);
    }
    return mesh;
}

// Returns how many positions are near enough.
std::int64_t expect_brute_force(const Mesh& mesh, const Lattice& lattice, double max_distance,
                                double jitter = 1.0) {
    const Mesh* const shape = &mesh;
    const TriangleTree tree = make_triangle_tree({&shape, 1});
    const test::Oracle oracle(mesh);
    const CullSettings settings{max_distance, jitter, 3};
    std::vector<std::uint32_t> scratch;
    std::int64_t kept = 0, wrong = 0;
    for (const LatticeBlock& block : blocks_near(tree, lattice, settings, {}))
        for (const Positions kind : {Positions::corners, Positions::centres}) {
            BlockAnswers answers;
            query_block(tree, lattice, settings, block, kind, scratch, answers);
            for (std::size_t s = 0; s < block_positions; ++s) {
                if (answers.triangle[s] == ClosestPoint::none) continue;
                const ClosestPoint c =
                    oracle.closest({answers.x[s], answers.y[s], answers.z[s]}, max_distance);
                ++kept;
                wrong += c.triangle != answers.triangle[s] ||
                         c.distance_squared != answers.distance_squared[s] ||
                         c.barycentric != glm::dvec2(answers.v[s], answers.w[s]);
            }
        }
    std::int64_t near_enough = 0;
    for (std::uint64_t id = 0; id < std::uint64_t(lattice.positions()); ++id) {
        const glm::dvec3 p = jittered_position(lattice, id, jitter, 3);
        near_enough += oracle.closest(p, max_distance).triangle != ClosestPoint::none;
    }
    EXPECT_GT(kept, 0);
    EXPECT_EQ(kept, near_enough);
    EXPECT_EQ(wrong, 0);
    return near_enough;
}

Lattice lattice_around(const glm::dvec3& middle, double reach) {
    Lattice lattice;
    lattice.n = {13, 10, 11};  // whole and broken blocks
    lattice.box.lo = middle - reach;
    lattice.box.hi = middle + reach;
    return lattice;
}

class BlockQuery : public testing::Test {
  protected:
    ~BlockQuery() override { set_vector_target("best"); }
};

TEST_F(BlockQuery, EqualsBruteForceForAnyTriangles) {
    for (const std::string& target : vector_targets()) {
        SCOPED_TRACE(target);
        set_vector_target(target);
        for (const std::uint32_t count : {1u, 2u, 9u, 700u}) {
            SCOPED_TRACE(count);
            for (const double max_distance : {0.02, 0.3, 5.0})
                expect_brute_force(soup(count), lattice_around(glm::dvec3(0), 1.3), max_distance);
        }
    }
}

// On a smooth surface most candidates are dropped by their planes; narrow ones have bounds of their own.
TEST_F(BlockQuery, FineSurfacesWithNarrowTriangles) {
    Mesh mesh = builtin_mesh("sphere", 1.0);
    for (glm::vec3& p : mesh.positions) p *= 0.2f;
    for (std::uint32_t n = 0; n < 300; ++n) {
        const glm::vec3 a = random_point(n, 130), b = a + 0.3f * random_point(n, 140);
        const float height = 0.3f / float(1u << n % 24);
        const auto first = std::uint32_t(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, b + height * random_point(n, 150)});
        mesh.triangles.push_back({{first + n % 3, first + (n + 1) % 3, first + (n + 2) % 3}, {}});
    }
    for (const std::string& target : vector_targets()) {
        SCOPED_TRACE(target);
        set_vector_target(target);
        expect_brute_force(mesh, lattice_around(glm::dvec3(0), 1.2), 0.2);
    }
}

TEST_F(BlockQuery, FarFromTheOriginAndForAnyDistance) {
    Mesh mesh = soup(200);
    for (glm::vec3& p : mesh.positions) p += glm::vec3(3000, -800, 100);
    expect_brute_force(mesh, lattice_around({3000, -800, 100}, 1.3), 0.2);
    for (const double reach : {1e6, 1e25})  // in float, squares of the latter are infinite
        expect_brute_force(soup(200), lattice_around(glm::dvec3(0), reach), 2.0 * reach);
}

// A disc may come within reach of a block where its triangle does not, nor its box.
TEST_F(BlockQuery, BlocksThatOnlyDiscsComeNearTo) {
    Mesh mesh;
    for (const glm::vec3 middle : {glm::vec3(0), glm::vec3(39.84f, 0.5f, 0.5f)}) {
        const auto first = std::uint32_t(mesh.positions.size());
        for (const glm::vec3 corner : {glm::vec3(0.3f, 0, 0), {0, -0.3f, 0}, {0, 0.3f, 0}})
            mesh.positions.push_back(middle + corner);
        for (std::size_t copy = 0; copy < TriangleTree::fan; ++copy)
            mesh.triangles.push_back({{first, first + 1, first + 2}, {}});
    }
    SourceParams source;
    source.buffer = {13.93, 9.45, 9.75};
    source.voxels = {68, 20, 20};
    TexturedMesh textured;
    textured.mesh = mesh;
    const Lattice lattice = make_lattice(source, {&textured, 1}, 1.0);
    EXPECT_EQ(expect_brute_force(mesh, lattice, 1.0, 0.0), 28);
}

// A block far from everything is not among those near; asked for all the same, it finds nothing.
TEST_F(BlockQuery, NothingIsNearAFarBlock) {
    const Mesh mesh = soup(9);
    const Mesh* const shape = &mesh;
    const TriangleTree tree = make_triangle_tree({&shape, 1});
    std::vector<std::uint32_t> scratch;
    BlockAnswers answers;
    query_block(tree, lattice_around(glm::dvec3(0), 50.0), {1.0, 1.0, 3}, {{0, 0, 0}, 0}, Positions::corners,
                scratch, answers);
    for (const std::uint32_t triangle : answers.triangle) EXPECT_EQ(triangle, ClosestPoint::none);
}

// Far more triangles within one voxel than a group usually finds.
TEST_F(BlockQuery, ManyTrianglesInOneVoxel) {
    Mesh mesh = soup(40000);
    for (glm::vec3& p : mesh.positions) p *= 0.01f;
    expect_brute_force(mesh, lattice_around(glm::dvec3(0.1), 1.3), 0.4);
}

// Real meshes: the search against a plain loop over all triangles, 100,000 positions each (5,000 in builds
// without optimisation and under sanitizers, where the loop would take minutes).

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
constexpr double positions = 5e3;
#else
constexpr double positions = 1e5;
#endif

class RealMeshes : public testing::TestWithParam<const char*> {};

TEST_P(RealMeshes, EqualBruteForceBitForBit) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, std::string("meshes/") + GetParam());
    std::vector<TexturedMesh> meshes = {test::textured(load_obj(file))};
    apply_uv(meshes[0].mesh, UvMode::planar_xz, bounds(meshes));
    const Bounds box = bounds(meshes);
    const double side = std::max({box.extent().x, box.extent().y, box.extent().z});
    const double max_distance = 0.03 * side;
    SourceParams source;
    const glm::dvec3 grown = box.extent() + 2.0 * max_distance;
    source.voxel_size = std::cbrt(2.0 * grown.x * grown.y * grown.z / positions);
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    ASSERT_GE(double(lattice.positions()), positions);

    const SplatSet set = generate(meshes, lattice, max_distance, 1.0, 11);
    const Mesh* const shape = &meshes[0].mesh;
    const TriangleTree tree = make_triangle_tree({&shape, 1});
    const test::Oracle oracle(meshes[0].mesh);
    std::atomic<std::int64_t> kept{0}, different{0};
    parallel_chunks(lattice.positions(), 256, [&](std::int64_t begin, std::int64_t end, int) {
        auto at = std::size_t(std::lower_bound(set.id.begin(), set.id.end(), std::uint64_t(begin)) -
                              set.id.begin());
        for (auto id = std::uint64_t(begin); id < std::uint64_t(end); ++id) {
            const glm::dvec3 p = jittered_position(lattice, id, 1.0, 11);
            const ClosestPoint slow = oracle.closest(p, max_distance),
                               fast = closest_point(tree, p, max_distance).closest;
            bool same = fast.triangle == slow.triangle && fast.distance_squared == slow.distance_squared;
            const bool in_set = at < set.id.size() && set.id[at] == id;
            same = same && in_set == (slow.triangle != ClosestPoint::none);
            if (in_set && same) {
                const Mesh::Triangle& t = meshes[0].mesh.triangles[slow.triangle];
                const auto corner = [&](std::size_t k) { return glm::dvec2(meshes[0].mesh.uvs[t.uv[k]]); };
                const glm::vec2 uv(corner(0) + (corner(1) - corner(0)) * slow.barycentric.x +
                                   (corner(2) - corner(0)) * slow.barycentric.y);
                same = fast.barycentric == slow.barycentric && set.uv[at] == uv &&
                       set.distance[at] == float(std::sqrt(slow.distance_squared));
            }
            at += in_set ? 1 : 0;
            kept += in_set ? 1 : 0;
            different += same ? 0 : 1;
        }
    });
    EXPECT_EQ(different, 0);
    EXPECT_EQ(kept, set.size());
    EXPECT_GT(kept, std::int64_t(positions / 50.0));
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealMeshes,
                         testing::Values("spot/spot_triangulated.obj", "smallbodies/phobos.obj",
                                         "smallbodies/epimetheus.obj", "smallbodies/216Kleopatra.obj",
                                         "qt3d/starfield.obj"));

TEST(RealMesh, AutomaticVoxelsKeepAboutCount) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "meshes/spot/spot_triangulated.obj");
    std::vector<TexturedMesh> meshes = {test::textured(load_obj(file))};
    SourceParams source;
    source.count = 200000;
    const double distance = resolved_max_distance(source, bounds(meshes));
    const SplatSet set = generate(meshes, make_lattice(source, meshes, distance), distance, 1.0, 3);
    EXPECT_NEAR(double(set.size()), 200000.0, 30000.0);
}

}  // namespace
}  // namespace astrosplat
