// Measures and planar projections of meshes, and the built-in shapes.
#include "source/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr double builtin_radius = 5.0;  // half the longer side

// 0..1 along one axis of a box; 1/2 where the box has no extent.
double along(double value, double lo, double hi) { return hi > lo ? (value - lo) / (hi - lo) : 0.5; }

glm::vec2 planar_uv(const glm::dvec3& p, UvMode mode, const Bounds& box) {
    const double x = along(p.x, box.lo.x, box.hi.x);
    const double y = along(p.y, box.lo.y, box.hi.y);
    const double z = along(p.z, box.lo.z, box.hi.z);
    if (mode == UvMode::planar_xy) return glm::vec2(x, y);
    if (mode == UvMode::planar_xz) return glm::vec2(x, 1.0 - z);
    return glm::vec2(1.0 - z, y);
}

void require_uv(const Mesh& mesh) {
    for (const Mesh::Triangle& triangle : mesh.triangles)
        for (const std::uint32_t uv : triangle.uv)
            if (uv == Mesh::no_uv)
                bad_input(
                    mesh.name, "",
                    "texture coordinates ('vt') at every face, or uv = \"planar-xz\" or another projection",
                    "a face without them");
}

// Two triangles a, b, c and a, c, d whose uvs have the positions' indices.
void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({{a, b, c}, {a, b, c}, 0});
    mesh.triangles.push_back({{a, c, d}, {a, c, d}, 0});
}

Mesh plane_mesh(double aspect) {
    const double half_width = aspect >= 1.0 ? builtin_radius : builtin_radius * aspect;
    const double half_height = aspect >= 1.0 ? builtin_radius / aspect : builtin_radius;
    Mesh mesh;
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const glm::vec2& uv : mesh.uvs)
        mesh.positions.emplace_back((2.0 * uv.x - 1.0) * half_width, 0.0, (1.0 - 2.0 * uv.y) * half_height);
    add_quad(mesh, 0, 1, 2, 3);
    return mesh;
}

Mesh disk_mesh(double aspect) {
    constexpr std::uint32_t segments = 256;
    // The picture keeps its shape: the disk shows the largest circle around its centre.
    const double u_scale = 0.5 / std::fmax(aspect, 1.0), v_scale = 0.5 * std::fmin(aspect, 1.0);
    Mesh mesh;
    mesh.positions.emplace_back(0.0f);
    mesh.uvs.emplace_back(0.5f);
    for (std::uint32_t i = 0; i < segments; ++i) {
        const double angle = 2.0 * real::pi * i / segments;
        const double x = real::cos(angle), z = -real::sin(angle);
        mesh.positions.emplace_back(x * builtin_radius, 0.0, z * builtin_radius);
        mesh.uvs.emplace_back(0.5 + u_scale * x, 0.5 - v_scale * z);
        const std::uint32_t a = 1 + i, b = 1 + (i + 1) % segments;
        mesh.triangles.push_back({{0, a, b}, {0, a, b}, 0});
    }
    return mesh;
}

Mesh sphere_mesh() {
    constexpr int rows = 64;
    std::vector<glm::dvec2> outline;
    std::vector<double> v;
    for (int j = 0; j <= rows; ++j) {
        v.push_back(static_cast<double>(j) / rows);
        const double y = -real::cos(v.back() * real::pi);
        outline.emplace_back(j == 0 || j == rows ? 0.0 : real::sin(v.back() * real::pi), y);
    }
    return revolved(outline, v, builtin_radius);
}

}  // namespace

Bounds bounds(const Mesh& mesh) {
    Bounds box;
    for (const glm::vec3& p : mesh.positions) box.add(glm::dvec3(p));
    return box;
}

double surface_area(const Mesh& mesh) {
    double sum = 0.0;
    for (const Mesh::Triangle& triangle : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[triangle.position[0]]);
        const glm::dvec3 b(mesh.positions[triangle.position[1]]);
        const glm::dvec3 c(mesh.positions[triangle.position[2]]);
        sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return sum;
}

void apply_uv(Mesh& mesh, UvMode mode, const Bounds& box) {
    if (mode == UvMode::mesh) return require_uv(mesh);
    mesh.uvs.clear();
    mesh.uvs.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) mesh.uvs.push_back(planar_uv(glm::dvec3(p), mode, box));
    for (Mesh::Triangle& triangle : mesh.triangles) triangle.uv = triangle.position;
}

Mesh revolved(std::span<const glm::dvec2> outline, std::span<const double> v, double scale) {
    constexpr std::uint32_t columns = 128;
    Mesh mesh;
    for (std::size_t j = 0; j < outline.size(); ++j) {
        const double r = outline[j].x, y = outline[j].y;
        for (std::uint32_t i = 0; i <= columns; ++i) {
            const double u = static_cast<double>(i) / columns;
            const double longitude = (u - 0.5) * 2.0 * real::pi;
            const bool seam = i == 0 || i == columns;
            const double x = seam ? 0.0 : r * real::sin(longitude);
            mesh.positions.emplace_back(scale * x, scale * y, scale * r * real::cos(longitude));
            mesh.uvs.emplace_back(u, v[j]);
        }
    }
    for (std::size_t j = 0; j + 1 < outline.size(); ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j) * (columns + 1) + i, d = a + columns + 1;
            if (outline[j].x > 0.0) mesh.triangles.push_back({{a, a + 1, d + 1}, {a, a + 1, d + 1}, 0});
            if (outline[j + 1].x > 0.0) mesh.triangles.push_back({{a, d + 1, d}, {a, d + 1, d}, 0});
        }
    }
    return mesh;
}

bool is_builtin_mesh(const std::filesystem::path& name) {
    return std::ranges::find(builtin_meshes, name.string()) != builtin_meshes.end();
}

Mesh builtin_mesh(const std::string& name, double aspect) {
    assert(aspect > 0.0);
    assert(name == "plane" || name == "disk" || name == "sphere");
    Mesh mesh = name == "plane" ? plane_mesh(aspect) : name == "disk" ? disk_mesh(aspect) : sphere_mesh();
    mesh.name = name;
    return mesh;
}

}  // namespace astrosplat
