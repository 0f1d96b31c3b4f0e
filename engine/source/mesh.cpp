// Polygons are split by ear clipping in their own plane, in double precision.
#include "source/mesh.h"

#include <glm/geometric.hpp>
#include <numeric>

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
                    mesh.name,
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
        v.push_back(double(j) / rows);
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
            const double u = double(i) / columns;
            const double longitude = (u - 0.5) * 2.0 * real::pi;
            const bool seam = i == 0 || i == columns;
            const double x = seam ? 0.0 : r * real::sin(longitude);
            mesh.positions.emplace_back(scale * x, scale * y, scale * r * real::cos(longitude));
            mesh.uvs.emplace_back(u, v[j]);
        }
    }
    for (std::size_t j = 0; j + 1 < outline.size(); ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const auto a = std::uint32_t(j) * (columns + 1) + i, d = a + columns + 1;
            if (outline[j].x > 0.0) mesh.triangles.push_back({{a, a + 1, d + 1}, {a, a + 1, d + 1}, 0});
            if (outline[j + 1].x > 0.0) mesh.triangles.push_back({{a, d + 1, d}, {a, d + 1, d}, 0});
        }
    }
    return mesh;
}

bool is_builtin_mesh(const fs::path& name) {
    return std::ranges::find(builtin_meshes, name.string()) != builtin_meshes.end();
}

Mesh builtin_mesh(const std::string& name, double aspect) {
    assert(aspect > 0.0);
    assert(name == "plane" || name == "disk" || name == "sphere");
    Mesh mesh = name == "plane" ? plane_mesh(aspect) : name == "disk" ? disk_mesh(aspect) : sphere_mesh();
    mesh.name = name;
    return mesh;
}

namespace {

using Point = glm::dvec2;
using Triple = std::array<std::uint32_t, 3>;

// Twice the signed area; > 0 when a, b, c turn left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Newell: twice the area vector, robust for corners that are not quite planar.
glm::dvec3 area_vector(std::span<const glm::vec3> corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a(corners[i]), b(corners[(i + 1) % corners.size()]);
        sum += glm::dvec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
    }
    return sum;
}

// Drops the axis the normal is closest to, so that the polygon turns left.
std::vector<Point> flatten(std::span<const glm::vec3> corners) {
    const glm::dvec3 n = area_vector(corners);
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    const double sign = n[axis] < 0.0 ? -1.0 : 1.0;
    std::vector<Point> flat;
    for (const glm::vec3& p : corners) {
        const glm::dvec3 q(p);
        flat.emplace_back(sign * q[(axis + 1) % 3], q[(axis + 2) % 3]);
    }
    return flat;
}

bool convex(const std::vector<Point>& p) {
    for (std::size_t i = 0; i < p.size(); ++i)
        if (turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0.0) return false;
    return true;
}

bool is_ear(const std::vector<Point>& p, const std::vector<std::uint32_t>& left, std::size_t i) {
    const std::size_t n = left.size();
    const Point &a = p[left[(i + n - 1) % n]], &b = p[left[i]], &c = p[left[(i + 1) % n]];
    if (turn(a, b, c) <= 0.0) return false;
    for (std::size_t k = 2; k + 1 < n; ++k) {
        const Point& q = p[left[(i + k) % n]];
        if (q == a || q == b || q == c) continue;  // a corner met twice, as along a cut to a hole
        if (turn(a, b, q) >= 0.0 && turn(b, c, q) >= 0.0 && turn(c, a, q) >= 0.0) return false;
    }
    return true;
}

std::vector<Triple> clip_ears(const std::vector<Point>& p) {
    std::vector<std::uint32_t> left(p.size());
    std::iota(left.begin(), left.end(), 0u);
    std::vector<Triple> triangles;
    while (left.size() > 3) {
        const std::size_t n = left.size();
        std::size_t ear = 0;
        while (ear < n && !is_ear(p, left, ear)) ++ear;
        if (ear == n) ear = 1;  // crosses itself or has no area: any corner will do
        triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
        left.erase(left.begin() + std::ptrdiff_t(ear));
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

}  // namespace

std::vector<Triple> triangulate(std::span<const glm::vec3> corners) {
    assert(corners.size() >= 3);
    const std::vector<Point> flat = flatten(corners);
    if (!convex(flat)) return flat.size() > max_concave_corners ? std::vector<Triple>() : clip_ears(flat);
    std::vector<Triple> fan;
    for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) fan.push_back({0, i, i + 1});
    return fan;
}

}  // namespace astrosplat
