// What a closest point looks like: picture, (u,v), face normal and texels per voxel of every triangle. In:
// textured meshes and the lattice's spacing. Out: colour and alpha at a ClosestPoint.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/buffer.h"
#include "generate/closest_triangle.h"
#include "source/textured_mesh.h"

namespace astrosplat {

struct SurfaceTriangle {
    glm::vec2 uv_a, uv_b, uv_c;  // at the corners
    glm::vec3 normal;            // unit, by the face's winding; +y for faces without area
    glm::vec2 box_texels;        // side of Filter::area's box: a voxel's side times the local texels per unit
    std::uint32_t mesh;
    const Texture* texture;
};

/// One entry for each triangle of all meshes in order. `spacing` is the voxel's sides in scene units. The
/// result points into `meshes`.
Buffer<SurfaceTriangle> surface_triangles(std::span<const TexturedMesh> meshes, const glm::dvec3& spacing);

inline glm::vec2 uv_at(const SurfaceTriangle& triangle, const glm::dvec2& barycentric) {
    const glm::dvec2 a(triangle.uv_a), ab = glm::dvec2(triangle.uv_b) - a, ac = glm::dvec2(triangle.uv_c) - a;
    return glm::vec2(a + ab * barycentric.x + ac * barycentric.y);
}

}  // namespace astrosplat
