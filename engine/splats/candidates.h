// Triangles that may be closest to one of a few positions, each between two bounds: a box along the axes and
// a disc in its own plane. Bounds only propose; closest_on_triangle decides, so nothing here reaches a
// result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace astrosplat {

/// What encloses a triangle, in float, relative to the middle of all meshes. Triangles without area have a
/// ball: normal 0.
struct TriangleBound {
    glm::vec3 lo, hi;          // box
    glm::vec3 center, normal;  // disc
    float radius;              // of the disc, scene units
};

/// Bounds as arrays, one entry a triangle.
struct CandidateList {
    static constexpr std::size_t most = 2048;
    static constexpr std::size_t room = most + 64;  // whole vectors are read and written at the end
    template <class T>
    using Array = std::array<T, room>;

    std::size_t count = 0;
    Array<std::uint32_t> triangle;
    Array<float> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
    Array<float> center_x, center_y, center_z, normal_x, normal_y, normal_z, radius;

    void add(std::uint32_t number, const TriangleBound& b) {
        triangle[count] = number;
        lo_x[count] = b.lo.x, lo_y[count] = b.lo.y, lo_z[count] = b.lo.z;
        hi_x[count] = b.hi.x, hi_y[count] = b.hi.y, hi_z[count] = b.hi.z;
        center_x[count] = b.center.x, center_y[count] = b.center.y, center_z[count] = b.center.z;
        normal_x[count] = b.normal.x, normal_y[count] = b.normal.y, normal_z[count] = b.normal.z;
        radius[count] = b.radius;
        ++count;
    }
};

/// Places in a CandidateList, ascending, and a lower bound of those triangles' distances.
struct NearCandidates {
    std::size_t count = 0;
    CandidateList::Array<std::uint32_t> place;
    CandidateList::Array<float> squared;  // square scene units
};

}  // namespace astrosplat
