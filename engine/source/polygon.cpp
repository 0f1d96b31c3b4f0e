// Ear clipping in the polygon's own plane, in double precision.
#include "source/polygon.h"

#include <cassert>
#include <cmath>
#include <glm/vec2.hpp>
#include <numeric>

namespace astrosplat {
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
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
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
