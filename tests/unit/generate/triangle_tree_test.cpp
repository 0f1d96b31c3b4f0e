// The closest point of one triangle in every region, of degenerate triangles, and of meshes.
#include "generate/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/shared_maths.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

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
                EXPECT_LE(static_cast<double>(level.lo_x[box]), local.x);
                EXPECT_LE(static_cast<double>(level.lo_y[box]), local.y);
                EXPECT_LE(static_cast<double>(level.lo_z[box]), local.z);
                EXPECT_GE(static_cast<double>(level.hi_x[box]), local.x);
                EXPECT_GE(static_cast<double>(level.hi_y[box]), local.y);
                EXPECT_GE(static_cast<double>(level.hi_z[box]), local.z);
            }
            box /= TriangleTree::fan;
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), static_cast<std::ptrdiff_t>(seen.size()));
}

// Points all around a mesh, also far from the origin, where floats are coarse.
TEST(TriangleTree, EqualsBruteForceWhereverTheMeshLies) {
    for (const double offset : {0.0, 1000.0, 1.0e6}) {
        Mesh mesh = builtin_mesh("sphere", 1.0);
        for (glm::vec3& p : mesh.positions) p = p * 20.0f + static_cast<float>(offset);
        const TriangleTree tree = tree_of({mesh});
        const test::Oracle oracle(mesh);
        std::uint32_t hint = ClosestPoint::none;
        for (std::uint32_t i = 0; i < 300; ++i) {
            const auto random = [&](std::uint32_t axis) {
                return 200.0 * static_cast<double>(shared::as_uniform(shared::as_hash(i, axis, 0, 99))) -
                       100.0;
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
            hint = i % static_cast<std::uint32_t>(mesh.triangles.size());
        }
    }
}

}  // namespace
}  // namespace astrosplat
