// Surface attributes of triangles, prepared once so that a kept position costs one lookup.
#include "generate/surface.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/text.h"
#include "source/textured_mesh.h"

namespace astrosplat {
namespace {

// |gradient of u * voxel side|, for u and v: the gradient is the one along the surface, so for gradients g of
// the barycentric weights it is uv_ab * g_b + uv_ac * g_c.
glm::vec2 texels_per_voxel(const SurfaceTriangle& t, const TriangleShape& s, const glm::dvec3& spacing) {
    const double determinant = s.ab_ab * s.ac_ac - s.ab_ac * s.ab_ac;
    if (!(determinant > 0.0)) return glm::vec2(0.0f);
    const glm::dvec3 g_b = (s.ab * s.ac_ac - s.ac * s.ab_ac) / determinant;
    const glm::dvec3 g_c = (s.ac * s.ab_ab - s.ab * s.ab_ac) / determinant;
    const glm::dvec2 uv_ab = glm::dvec2(t.uv_b) - glm::dvec2(t.uv_a);
    const glm::dvec2 uv_ac = glm::dvec2(t.uv_c) - glm::dvec2(t.uv_a);
    const glm::dvec3 along_u = (g_b * uv_ab.x + g_c * uv_ac.x) * spacing;
    const glm::dvec3 along_v = (g_b * uv_ab.y + g_c * uv_ac.y) * spacing;
    return glm::vec2(std::sqrt(glm::dot(along_u, along_u)) * static_cast<double>(t.texture->image.width),
                     std::sqrt(glm::dot(along_v, along_v)) * static_cast<double>(t.texture->image.height));
}

// The same for a picture that is seen through a camera, at the face's own depth.
glm::vec2 texels_per_voxel(const TexturedMesh& m, const SurfaceTriangle& t, const TriangleShape& s,
                           const glm::dvec3& spacing) {
    const std::optional<PlaceInPicture> seen = place_in_picture(*m.camera, s.a + (s.ab + s.ac) / 3.0);
    if (!seen) return glm::vec2(0.0f);
    const double texels_per_unit =
        static_cast<double>(t.texture->image.height) / picture_height_at(*m.camera, seen->depth);
    const glm::dmat3& axes = m.camera->world_from_camera;
    return glm::vec2(glm::length(axes[0] * spacing), glm::length(axes[1] * spacing)) *
           static_cast<float>(texels_per_unit);
}

glm::vec3 face_normal(const TriangleShape& s) {
    const glm::dvec3 n = glm::cross(s.ab, s.ac);
    const double length = std::sqrt(glm::dot(n, n));
    return length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f, 1.0f, 0.0f);
}

SurfaceTriangle surface_triangle(const TexturedMesh& m, const Mesh::Triangle& face,
                                 const TriangleShape& shape, const glm::dvec3& spacing) {
    const auto uv = [&](std::size_t corner) {
        return face.uv[corner] == Mesh::no_uv ? glm::vec2(0.0f) : m.mesh.uvs[face.uv[corner]];
    };
    const std::size_t texture = m.textures.size() == 1 ? 0 : face.material;
    assert(texture < m.textures.size());
    SurfaceTriangle t{uv(0),
                      uv(1),
                      uv(2),
                      face_normal(shape),
                      {},
                      0,
                      &m.textures[texture],
                      m.camera ? &*m.camera : nullptr};
    t.box_texels = m.camera ? texels_per_voxel(m, t, shape, spacing) : texels_per_voxel(t, shape, spacing);
    return t;
}

}  // namespace

Buffer<SurfaceTriangle> surface_triangles(std::span<const TexturedMesh> meshes, const glm::dvec3& spacing) {
    std::size_t count = 0, first = 0;
    for (const TexturedMesh& m : meshes) count += m.mesh.triangles.size();
    Buffer<SurfaceTriangle> triangles(count);
    for (std::size_t number = 0; number < meshes.size(); ++number) {
        const TexturedMesh& m = meshes[number];
        const auto corner = [&](const Mesh::Triangle& face, std::size_t k) {
            return glm::dvec3(m.mesh.positions[face.position[k]]);
        };
        parallel_each(m.mesh.triangles.size(), 4096, [&](std::size_t i) {
            const Mesh::Triangle& face = m.mesh.triangles[i];
            const TriangleShape shape = triangle_shape(corner(face, 0), corner(face, 1), corner(face, 2));
            triangles[first + i] = surface_triangle(m, face, shape, spacing);
            triangles[first + i].mesh = static_cast<std::uint32_t>(number);
        });
        first += m.mesh.triangles.size();
    }
    return triangles;
}

void describe_pictures(std::span<const TexturedMesh> meshes, SplatSetFacts& facts) {
    std::vector<std::string> credits;
    facts.divided = false;
    for (const TexturedMesh& m : meshes) {
        for (const Texture& texture : m.textures) {
            facts.divided = facts.divided || texture.divided;
            credits.push_back(texture.credit);
        }
    }
    facts.credit = joined_once(credits);
}

std::optional<glm::vec2> uv_of(const SurfaceTriangle& triangle, const glm::dvec2& barycentric,
                               const glm::dvec3& position) {
    if (!triangle.camera) {
        const glm::dvec2 a(triangle.uv_a), ab = glm::dvec2(triangle.uv_b) - a,
                                           ac = glm::dvec2(triangle.uv_c) - a;
        return glm::vec2(a + ab * barycentric.x + ac * barycentric.y);
    }
    const std::optional<PlaceInPicture> seen = place_in_picture(*triangle.camera, position);
    if (!seen) return std::nullopt;
    return glm::vec2(seen->uv);
}

}  // namespace astrosplat
