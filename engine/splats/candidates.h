// Triangles that may be closest to one of a few positions, each between two bounds: a box along the axes and
// a disc in its own plane. Bounds only propose; closest_on_triangle decides, so nothing here reaches a
// result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>

namespace astrosplat {

/// What encloses a triangle, in float, relative to the middle of all meshes. Triangles without area have a
/// ball: normal 0.
struct TriangleBound {
    glm::vec3 lo, hi;          // box
    glm::vec3 center, normal;  // disc
    float radius;              // of the disc, scene units
};

/// Bounds of N triangles as arrays.
template <std::size_t N>
struct BoundArrays {
    using Numbers = std::array<float, N>;
    std::array<std::uint32_t, N> triangle;
    Numbers lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
    Numbers center_x, center_y, center_z, normal_x, normal_y, normal_z, radius;

    void set(std::size_t i, std::uint32_t number, const TriangleBound& b) {
        triangle[i] = number;
        lo_x[i] = b.lo.x, lo_y[i] = b.lo.y, lo_z[i] = b.lo.z;
        hi_x[i] = b.hi.x, hi_y[i] = b.hi.y, hi_z[i] = b.hi.z;
        center_x[i] = b.center.x, center_y[i] = b.center.y, center_z[i] = b.center.z;
        normal_x[i] = b.normal.x, normal_y[i] = b.normal.y, normal_z[i] = b.normal.z;
        radius[i] = b.radius;
    }
};

/// Eight triangles that lie together; what is handed around. One that has fewer repeats its last.
struct TriangleCluster : BoundArrays<8> {
    static constexpr std::size_t size = 8;
};

struct CandidateList : BoundArrays<2048 + 64> {
    static constexpr std::size_t most = 2048;  // the rest is room for whole vectors at the end
    std::size_t count = 0;

    /// False when there is no room.
    bool add(const TriangleCluster& cluster) {
        if (count + TriangleCluster::size > most) return false;
        copy(cluster.triangle, triangle);
        copy(cluster.lo_x, lo_x), copy(cluster.lo_y, lo_y), copy(cluster.lo_z, lo_z);
        copy(cluster.hi_x, hi_x), copy(cluster.hi_y, hi_y), copy(cluster.hi_z, hi_z);
        copy(cluster.center_x, center_x), copy(cluster.center_y, center_y), copy(cluster.center_z, center_z);
        copy(cluster.normal_x, normal_x), copy(cluster.normal_y, normal_y), copy(cluster.normal_z, normal_z);
        copy(cluster.radius, radius);
        count += TriangleCluster::size;
        return true;
    }

  private:
    template <class From, class To>
    void copy(const From& from, To& to) const {
        std::memcpy(to.data() + count, from.data(), sizeof from);
    }
};

/// Places in a CandidateList, ascending, and a lower bound of those triangles' distances.
struct NearCandidates {
    std::size_t count = 0;
    std::array<std::uint32_t, CandidateList::most + 64> place;
    std::array<float, CandidateList::most + 64> squared;  // square scene units
};

}  // namespace astrosplat
