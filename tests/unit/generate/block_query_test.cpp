// Block queries against every triangle, for meshes that bounds could get wrong: needles, points, huge beside
// tiny triangles, few triangles, very many, far from the origin; on every instruction set.
#include "generate/blocks.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/parallel.h"
#include "core/shared_maths.h"
#include "generate/lattice.h"
#include "unit/generate/generate_support.h"
#include "unit/generate/lattice_positions.h"

namespace astrosplat {
namespace {

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
        const float size = 1.0f / static_cast<float>(1u << n % 9);
        glm::vec3 b = a + size * random_point(n, 110), c = a + size * random_point(n, 120);
        if (n % 16 == 3) c = a + (b - a) * 0.3f + glm::vec3(0, 1e-6f, 0);
        if (n % 16 == 7) c = a + (b - a) * 0.5f;
        if (n % 16 == 11) b = c = a;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
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
    for (const LatticeBlock& block : blocks_near(tree, lattice, settings, {})) {
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
    }
    std::int64_t near_enough = 0;
    for (std::uint64_t id = 0; id < static_cast<std::uint64_t>(lattice.positions()); ++id) {
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
        const float height = 0.3f / static_cast<float>(1u << n % 24);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
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
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
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

}  // namespace
}  // namespace astrosplat
