// Pictures in scene units and back walls: places worked out by hand, and what stays as it was.
#include "source/textured_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "source/shapes.h"

namespace astrosplat {
namespace {

// One vertex, in the middle of a large box.
glm::vec2 uv_at(const glm::vec3& p, const SourceParams& source, double aspect) {
    Mesh mesh;
    mesh.positions = {p, p, p};
    mesh.triangles = {{{0, 1, 2}, {0, 1, 2}, 0}};
    apply_source_uv(mesh, source, {glm::dvec3(-50.0), glm::dvec3(50.0)}, aspect);
    return mesh.uvs[0];
}

SourceParams planar(UvMode mode, double width) {
    SourceParams source;
    source.uv = mode;
    source.uv_width = width;
    return source;
}

TEST(PlanarUv, AWidthInSceneUnitsDoesNotDependOnTheMesh) {
    // A picture 8 wide and 4 high.
    EXPECT_EQ(uv_at({2, 1, 7}, planar(UvMode::planar_xy, 8.0), 2.0), glm::vec2(0.75f, 0.75f));
    EXPECT_EQ(uv_at({2, 7, 1}, planar(UvMode::planar_xz, 8.0), 2.0), glm::vec2(0.75f, 0.25f));
    EXPECT_EQ(uv_at({7, 1, 2}, planar(UvMode::planar_yz, 8.0), 2.0), glm::vec2(0.25f, 0.75f));
    SourceParams moved = planar(UvMode::planar_xy, 8.0);
    moved.uv_center = {2.0, 1.0, 0.0};
    EXPECT_EQ(uv_at({2, 1, 7}, moved, 2.0), glm::vec2(0.5f, 0.5f));
    EXPECT_EQ(uv_at({6, 3, 7}, moved, 2.0), glm::vec2(1.0f, 1.0f));
}

TEST(PlanarUv, WithoutAWidthThePictureIsStretchedOverTheBox) {
    EXPECT_EQ(uv_at({25, -50, 7}, planar(UvMode::planar_xy, 0.0), 2.0), glm::vec2(0.75f, 0.0f));
}

Mesh ball(BackWall back) {
    Mesh mesh = builtin_mesh("sphere", 1.0);
    SourceParams source = planar(UvMode::planar_xy, 0.0);
    source.back = back;
    apply_source_uv(mesh, source, bounds(mesh), 1.0);
    return mesh;
}

TEST(PlanarUv, AMirroredBackReadsRightFromBehind) {
    const Mesh mesh = ball(BackWall::mirrored);
    int behind = 0;
    for (const Mesh::Triangle& t : mesh.triangles) {
        float z = 0.0f;
        for (const std::uint32_t corner : t.position) z += mesh.positions[corner].z;
        behind += z < 0.0f;
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p = mesh.positions[t.position[k]];
            const glm::vec2 uv = mesh.uvs[t.uv[k]];
            ASSERT_NEAR(uv.x, 0.5f + (z < 0.0f ? -0.1f : 0.1f) * p.x, 1e-5f);
            ASSERT_NEAR(uv.y, 0.5f + 0.1f * p.y, 1e-5f);
        }
    }
    EXPECT_EQ(behind, static_cast<int>(mesh.triangles.size() / 2));
}

TEST(PlanarUv, AVariedBackLeavesTheFrontAndHasNoJump) {
    const Mesh same = ball(BackWall::same), varied = ball(BackWall::varied);
    double sum = 0.0, most = 0.0;
    int behind = 0;
    for (std::size_t i = 0; i < same.positions.size(); ++i) {
        const auto off = static_cast<double>(glm::length(varied.uvs[i] - same.uvs[i]));
        if (same.positions[i].z >= 0.0f) {
            ASSERT_EQ(off, 0.0);
        } else if (same.positions[i].z < -2.5f) {
            sum += off, ++behind;
        }
        most = std::max(most, off);
    }
    EXPECT_GT(sum / behind, 0.04);
    EXPECT_LT(most, 0.45);
    for (const Mesh::Triangle& t : varied.triangles)
        for (int k = 0; k < 3; ++k)
            ASSERT_LT(glm::length(varied.uvs[t.uv[k]] - varied.uvs[t.uv[(k + 1) % 3]]), 0.1f);
}

}  // namespace
}  // namespace astrosplat
