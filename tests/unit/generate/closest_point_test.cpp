// The closest point of one triangle in every region, of degenerate triangles, and of meshes.
#include "generate/closest_point.h"

#include <gtest/gtest.h>

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

TEST(ClosestPointIndex, TiesGoToTheLowestTriangle) {
    const Mesh one = square(1.0f);
    const ClosestPointIndex index(std::vector<Mesh>{one, one, one});
    EXPECT_EQ(index.triangle_count(), 6);
    EXPECT_EQ(index.closest({0.5, 0.25, 0.5}, 1.0).triangle, 0u);  // on the diagonal: six triangles tie
    EXPECT_EQ(index.closest({0.2, 0.25, 0.8}, 1.0).triangle, 1u);  // inside the second: three tie
    EXPECT_EQ(index.closest({0.5, 0.25, 0.5}, 1.0, 5).triangle, 0u);
    EXPECT_EQ(index.closest({0.5, -0.25, 0.5}, 1.0).triangle, 0u);
}

TEST(ClosestPointIndex, MaxDistanceIsInclusive) {
    const ClosestPointIndex index(std::vector<Mesh>{square(1.0f)});
    EXPECT_EQ(index.closest({0.7, 0.25, 0.3}, 0.25).triangle, 0u);
    EXPECT_EQ(index.closest({0.7, -0.25, 0.3}, 0.25).triangle, 0u);
    EXPECT_EQ(index.closest({0.7, 0.25, 0.3}, std::nextafter(0.25, 0.0)).triangle, ClosestPoint::none);
    EXPECT_EQ(index.closest_brute_force({0.7, 0.25, 0.3}, 0.25).triangle, 0u);
}

TEST(ClosestPointIndex, Sphere) {
    const ClosestPointIndex index(std::vector<Mesh>{builtin_mesh("sphere", 1.0)});
    for (const double radius : {0.5, 4.0, 4.9, 5.1, 6.0, 20.0}) {
        const dvec3 direction = glm::normalize(dvec3(1.0, radius, -0.3));
        const double distance = std::sqrt(index.closest(direction * radius, 100.0).distance_squared);
        EXPECT_NEAR(distance, std::fabs(radius - 5.0), 0.01)
            << radius;  // facets cut up to r (1 - cos(half a step))
    }
}

TEST(ClosestPointIndex, NoTriangles) {
    const ClosestPointIndex index(std::vector<Mesh>{Mesh()});
    EXPECT_EQ(index.closest({0, 0, 0}, 10.0).triangle, ClosestPoint::none);
}

// Points all around a mesh, also far from the origin, where Embree's floats are coarse.
TEST(ClosestPointIndex, EqualsBruteForceWhereverTheMeshLies) {
    for (const double offset : {0.0, 1000.0, 1.0e6}) {
        Mesh mesh = builtin_mesh("sphere", 1.0);
        for (glm::vec3& p : mesh.positions) p = p * 20.0f + static_cast<float>(offset);
        const ClosestPointIndex index(std::vector<Mesh>{mesh});
        std::uint32_t hint = ClosestPoint::none;
        for (std::uint32_t i = 0; i < 300; ++i) {
            const auto random = [&](std::uint32_t axis) {
                return 200.0 * static_cast<double>(shared::as_uniform(shared::as_hash(i, axis, 0, 99))) -
                       100.0;
            };
            const dvec3 p = offset + dvec3(random(0), random(1), random(2));
            const ClosestPoint fast = index.closest(p, 60.0, hint), slow = index.closest_brute_force(p, 60.0);
            EXPECT_EQ(fast.triangle, slow.triangle) << offset << " " << i;
            EXPECT_EQ(fast.distance_squared, slow.distance_squared) << offset << " " << i;
            EXPECT_EQ(fast.barycentric, slow.barycentric) << offset << " " << i;
            hint = i % static_cast<std::uint32_t>(mesh.triangles.size());
        }
    }
}

// The middle of a triangle's disc counts only where it is near enough; with no tolerance it is the closest
// point itself. The place lies on the mesh.
TEST(ClosestPointIndex, ANearPlaceIsFartherByTheToleranceAtMost) {
    Mesh mesh = builtin_mesh("sphere", 1.0);
    for (glm::vec3& p : mesh.positions) p = p * 2.0f;
    const ClosestPointIndex index(std::vector<Mesh>{mesh});
    std::uint32_t hint = ClosestPoint::none;
    int none = 0, middles = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const auto random = [&](std::uint32_t axis) {
            return 60.0 * static_cast<double>(shared::as_uniform(shared::as_hash(i, axis, 0, 98))) - 30.0;
        };
        const dvec3 p(random(0), random(1), random(2));
        const double tolerance = i % 4 * 0.5;
        const ClosestPoint closest = index.closest_brute_force(p, 12.0);
        const NearPlace near = index.near_place(p, 12.0, tolerance, hint);
        if (near.slot == ClosestPoint::none) {
            EXPECT_EQ(closest.triangle, ClosestPoint::none) << i;
            ++none;
            continue;
        }
        const double least = std::sqrt(index.closest_brute_force(p, 100.0).distance_squared);
        EXPECT_LE(near.distance, least + tolerance + 1e-4) << i;
        EXPECT_GE(near.distance, least - 1e-4) << i;
        EXPECT_NEAR(glm::length(near.at - p), near.distance, 1e-4) << i;
        EXPECT_NEAR(index.closest_brute_force(near.at, 1.0).distance_squared, 0.0, 1e-8) << i;
        middles += near.distance > least + 1e-4;
        hint = near.slot;
    }
    EXPECT_GT(none, 100);
    EXPECT_GT(middles, 100);
}

}  // namespace
}  // namespace astrosplat
