// The surface at a closest point: picture, (u,v), face normal and texels per voxel of every triangle. In:
// textured meshes and the lattice's spacing. Out: colour and alpha at a ClosestPoint.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "core/buffer.h"
#include "generate/triangle_tree.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

struct SurfaceTriangle {
    glm::vec2 uv_a, uv_b, uv_c;  // at the corners
    glm::vec3 normal;            // unit, by the face's winding; +y for faces without area
    glm::vec2 box_texels;        // side of Filter::area's box: a voxel's side times the local texels per unit
    std::uint32_t mesh;
    const Texture* texture;
    const Camera* camera;  // uv = "camera"; null: the face's own (u,v)
};

/// One entry for each triangle of all meshes in order. `spacing` is the voxel's sides in scene units. The
/// result points into `meshes`.
Buffer<SurfaceTriangle> surface_triangles(std::span<const TexturedMesh> meshes, const glm::dvec3& spacing);

/// Facts about a set as a whole that follow from its pictures: SplatSetFacts::divided and credit.
void describe_pictures(std::span<const TexturedMesh> meshes, SplatSetFacts& facts);

/// (u,v) of a position whose closest point is there: that point's, or, where a camera took the picture, the
/// position's own; empty behind that camera.
std::optional<glm::vec2> uv_of(const SurfaceTriangle& triangle, const glm::dvec2& barycentric,
                               const glm::dvec3& position);

}  // namespace astrosplat
