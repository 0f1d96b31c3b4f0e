#include "source/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr double shape_radius = 5.0;
constexpr int outline_pieces = 128;  // about as long as a column of faces is wide

// A shape's outline and the v of its points.
struct Outline {
    std::vector<glm::dvec2> points;
    std::vector<double> v;

    void add(double r, double y, double at) {
        points.emplace_back(r, y);
        v.push_back(at);
    }
};

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
    for (Mesh::Triangle triangle : other.triangles) {
        for (std::uint32_t& index : triangle.position) index += first;
        triangle.uv = triangle.position;
        mesh.triangles.push_back(triangle);
    }
}

// From `first` to `last` degrees of latitude + 90, its poles exactly on the axis.
Outline arc(double last_degrees, double height) {
    const int rows = std::max(2, static_cast<int>(std::ceil(64.0 * last_degrees / 180.0)));
    Outline outline;
    for (int j = 0; j <= rows; ++j) {
        const double degrees = last_degrees * j / rows;
        const bool pole = j == 0 || degrees >= 180.0;
        const double t = real::radians(degrees);
        outline.add(pole ? 0.0 : real::sin(t), -height * real::cos(t), degrees / 180.0);
    }
    return outline;
}

Mesh turned(const Outline& outline, double scale) { return revolved(outline.points, outline.v, scale); }

// Points between the given ones so that no piece is much longer than a column is wide.
Outline divided(const std::vector<glm::dvec2>& points) {
    std::vector<double> at(1, 0.0);
    for (std::size_t i = 1; i < points.size(); ++i)
        at.push_back(at.back() + glm::length(points[i] - points[i - 1]));
    Outline outline;
    const double whole = at.back();
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double length = at[i] - at[i - 1];
        if (!(length > 0.0)) continue;
        const int pieces = std::max(1, static_cast<int>(std::ceil(outline_pieces * length / whole)));
        for (int k = 0; k < pieces; ++k) {
            const double share = static_cast<double>(k) / pieces;
            const glm::dvec2 p = points[i - 1] + (points[i] - points[i - 1]) * share;
            outline.add(p.x, p.y, (at[i - 1] + length * share) / whole);
        }
    }
    outline.add(points.back().x, points.back().y, 1.0);
    return outline;
}

Mesh revolution(const ShapeParams& shape) {
    std::vector<glm::dvec2> points(shape.outline.begin(), shape.outline.end());
    if (points.size() < 2)
        bad_input("revolution", "", "an outline of at least 2 points [r, y]",
                  fmt::format("{}", points.size()));
    if (points.front().y > points.back().y) std::ranges::reverse(points);
    return turned(divided(points), 1.0);
}

Mesh hourglass(const ShapeParams& shape) {
    Outline outline;
    constexpr int rows = 128;
    for (int j = 0; j <= rows; ++j) {
        const double t = real::pi * j / rows;
        const bool pole = j == 0 || j == rows;
        const double lobes = std::fabs(real::sin(2.0 * t)), spheroid = real::sin(t);
        const double r = shape.width * (shape.waist * spheroid + (1.0 - shape.waist) * lobes);
        outline.add(pole ? 0.0 : r, -real::cos(t), static_cast<double>(j) / rows);
    }
    return turned(outline, shape_radius);
}

Mesh shell(const ShapeParams& shape) {
    const Outline sphere = arc(180.0, 1.0);
    Mesh mesh = turned(sphere, shape_radius);
    Mesh inner = turned(sphere, shape_radius * (1.0 - shape.thickness));
    for (Mesh::Triangle& triangle : inner.triangles) std::swap(triangle.position[1], triangle.position[2]);
    append(mesh, inner);
    return mesh;
}

// Radii whose number per length falls as e^(-c r), r = 1 the last.
double nested_radius(int index, int count, double concentration) {
    const double share = static_cast<double>(index + 1) / count;
    if (concentration < 1e-6 || index + 1 == count) return share;
    return -real::log(1.0 - share * (1.0 - real::exp(-concentration))) / concentration;
}

Mesh spheroid(const ShapeParams& shape) {
    const Outline outline = arc(180.0, 1.0 - shape.flattening);
    Mesh mesh;
    for (int i = 0; i < shape.shells; ++i)
        append(mesh, turned(outline, shape_radius * nested_radius(i, shape.shells, shape.concentration)));
    return mesh;
}

Mesh ring(const ShapeParams& shape) {
    constexpr int rows = 64;
    Outline outline;
    for (int j = 0; j <= rows; ++j) {
        const double t = 2.0 * real::pi * (j % rows) / rows;  // the seam is one circle
        outline.add(1.0 - shape.tube - shape.tube * real::cos(t), -shape.tube * real::sin(t),
                    static_cast<double>(j) / rows);
    }
    return turned(outline, shape_radius);
}

struct TurnedShape {
    const char* name;
    Mesh (*make)(const ShapeParams&);
};
constexpr std::array turned_shapes = {
    TurnedShape{"revolution", revolution},
    TurnedShape{"hourglass", hourglass},
    TurnedShape{"shell", shell},
    TurnedShape{"bubble",
                [](const ShapeParams& s) { return turned(arc(180.0 - s.opening, 1.0), shape_radius); }},
    TurnedShape{"spheroid", spheroid},
    TurnedShape{"ring", ring}};

}  // namespace

bool is_turned_shape(const std::string& name) {
    return std::ranges::any_of(turned_shapes, [&](const TurnedShape& shape) { return name == shape.name; });
}

Mesh turned_shape(const std::string& name, const ShapeParams& shape) {
    const auto found =
        std::ranges::find_if(turned_shapes, [&](const TurnedShape& s) { return name == s.name; });
    Mesh mesh = found->make(shape);
    mesh.name = name;
    return mesh;
}

}  // namespace astrosplat
