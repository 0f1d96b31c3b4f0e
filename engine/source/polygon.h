// Splits the polygons of mesh files into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace astrosplat {

/// The most corners a polygon that is not convex may have: clipping takes cubic time at worst.
inline constexpr std::size_t max_concave_corners = 4096;

/// Triangles of a polygon with n >= 3 corners, as n - 2 triples of indices into `corners`, wound as the
/// polygon is. Convex ones become a fan around corner 0; others lose ears (Meisters 1975) in the plane their
/// normal (Newell's) is closest to. A polygon that crosses itself becomes some n - 2 triangles of its
/// corners. Empty when it is concave and has more than max_concave_corners.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners);

}  // namespace astrosplat
