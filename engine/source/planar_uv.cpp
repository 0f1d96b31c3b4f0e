#include "source/planar_uv.h"

#include <algorithm>
#include <cassert>

#include "core/shared_noise.h"

namespace astrosplat {
namespace {

constexpr float displacement = 0.35f;  // of the picture, by noise of 1
constexpr double noise_feature = 0.3;  // of the box's longest side
constexpr std::uint32_t noise_seed = 0x5eedu;

// The axis along which a picture is projected; it reads right from its positive end.
int depth_axis(UvMode mode) { return mode == UvMode::planar_xy ? 2 : mode == UvMode::planar_xz ? 1 : 0; }

// 0 from the middle of the box on forward, 1 at its back.
double backness(const glm::dvec3& p, int axis, const Bounds& box) {
    const double middle = 0.5 * (box.lo[axis] + box.hi[axis]), half = middle - box.lo[axis];
    return half > 0.0 ? std::clamp((middle - p[axis]) / half, 0.0, 1.0) : 0.0;
}

void vary(Mesh& mesh, int axis, const Bounds& box) {
    const glm::dvec3 extent = box.extent();
    const double frequency = 1.0 / (noise_feature * std::max({extent.x, extent.y, extent.z, 1e-12}));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 p(mesh.positions[i]);
        const double t = backness(p, axis, box);
        const auto fade = static_cast<float>(t * t * (3.0 - 2.0 * t));
        const glm::vec3 at((p - box.lo) * frequency);
        mesh.uvs[i].x += displacement * fade * shared::as_noise(at.x, at.y, at.z, noise_seed);
        mesh.uvs[i].y += displacement * fade * shared::as_noise(at.x, at.y, at.z, noise_seed + 1);
    }
}

void mirror(Mesh& mesh, int axis, const Bounds& box) {
    const auto count = static_cast<std::uint32_t>(mesh.uvs.size());
    for (std::uint32_t i = 0; i < count; ++i) mesh.uvs.emplace_back(1.0f - mesh.uvs[i].x, mesh.uvs[i].y);
    for (Mesh::Triangle& triangle : mesh.triangles) {
        glm::dvec3 middle(0.0);
        for (const std::uint32_t corner : triangle.position)
            middle += glm::dvec3(mesh.positions[corner]) / 3.0;
        if (backness(middle, axis, box) > 0.0)
            for (std::uint32_t& uv : triangle.uv) uv += count;
    }
}

}  // namespace

Bounds picture_box(UvMode mode, double width, const glm::dvec3& center, double aspect) {
    assert(width > 0.0 && aspect > 0.0);
    const double height = width / aspect;
    glm::dvec3 extent(width, height, height);
    if (mode == UvMode::planar_yz) extent = {0.0, height, width};
    return {center - 0.5 * extent, center + 0.5 * extent};
}

void tell_back_apart(Mesh& mesh, UvMode mode, BackWall back, const Bounds& box) {
    assert(mode != UvMode::mesh && mesh.uvs.size() == mesh.positions.size());
    if (back == BackWall::varied) vary(mesh, depth_axis(mode), box);
    if (back == BackWall::mirrored) mirror(mesh, depth_axis(mode), box);
}

void apply_source_uv(Mesh& mesh, const SourceParams& source, const Bounds& box, double aspect) {
    const bool in_units = source.uv != UvMode::mesh && source.uv_width > 0.0;
    apply_uv(mesh, source.uv,
             in_units ? picture_box(source.uv, source.uv_width, source.uv_center, aspect) : box);
    if (source.uv != UvMode::mesh) tell_back_apart(mesh, source.uv, source.back, box);
}

}  // namespace astrosplat
