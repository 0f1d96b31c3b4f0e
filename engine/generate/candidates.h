// Triangles that may be closest to one of a few positions, with what bounds their distances from below: boxes
// along the axes around eight of them, a disc in each one's plane, and the planes through its edges. Bounds
// only propose; closest_on_triangle decides, so nothing here reaches a result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace astrosplat {

/// What encloses a triangle, in float, relative to the middle of all meshes: a disc in its plane. Triangles
/// without area have a ball: normal 0.
struct TriangleBound {
    glm::vec3 center, normal;
    float radius;  // scene units
};

/// The planes through a triangle's edges, upright on its own plane: unit normals that point away from the
/// triangle, and their distances from the disc's middle. All 0 where the bound is a ball.
struct TriangleEdges {
    std::array<float, 3> normal_x, normal_y, normal_z;
    std::array<float, 3> offset;  // scene units
};

/// Bounds of N triangles as arrays; `slot` says where the rest of them is kept.
template <std::size_t N>
struct BoundArrays {
    using Numbers = std::array<float, N>;
    std::array<std::uint32_t, N> slot;
    Numbers center_x, center_y, center_z, normal_x, normal_y, normal_z, radius;

    void set(std::size_t i, std::uint32_t place, const TriangleBound& b) {
        slot[i] = place;
        center_x[i] = b.center.x, center_y[i] = b.center.y, center_z[i] = b.center.z;
        normal_x[i] = b.normal.x, normal_y[i] = b.normal.y, normal_z[i] = b.normal.z;
        radius[i] = b.radius;
    }
    TriangleBound bound(std::size_t i) const {
        return {{center_x[i], center_y[i], center_z[i]}, {normal_x[i], normal_y[i], normal_z[i]}, radius[i]};
    }
};

/// Eight triangles that lie together; what is handed around. One that has fewer repeats its last.
struct TriangleCluster : BoundArrays<8> {
    static constexpr std::size_t size = 8;
};

/// The box of a cluster, in the same coordinates, and a place on one of its triangles.
struct ClusterBox {
    glm::vec3 lo, hi;
    glm::vec3 place;     // the middle of a disc; not a number where all bounds are balls
    std::uint32_t slot;  // of that triangle
};

/// Clusters near some place, by number, and their boxes.
struct ClusterList {
    static constexpr std::size_t most = 4096;  // the arrays have room for whole vectors at the end
    using Numbers = std::array<float, most + 64>;
    std::size_t count = 0;
    alignas(64) std::array<std::uint32_t, most + 64> cluster, slot;
    alignas(64) Numbers lo_x, lo_y, lo_z, hi_x, hi_y, hi_z, place_x, place_y, place_z;
    // By the last measure_boxes: squared distances of the boxes from its point, and whose place is nearest to
    // it; `count` when there is none.
    alignas(64) Numbers squared;
    std::size_t nearest;

    glm::vec3 place(std::size_t i) const { return {place_x[i], place_y[i], place_z[i]}; }

    /// False when there is no room.
    bool add(std::uint32_t number, const ClusterBox& box) {
        if (count == most) return false;
        cluster[count] = number, slot[count] = box.slot;
        place_x[count] = box.place.x, place_y[count] = box.place.y, place_z[count] = box.place.z;
        lo_x[count] = box.lo.x, lo_y[count] = box.lo.y, lo_z[count] = box.lo.z;
        hi_x[count] = box.hi.x, hi_y[count] = box.hi.y, hi_z[count] = box.hi.z;
        ++count;
        return true;
    }
};

/// Triangles that a block chose.
struct CandidateList : BoundArrays<8192 + 64> {
    static constexpr std::size_t most = 8192;  // the rest is room for whole vectors at the end
    std::size_t count = 0;
};

/// Candidates, by place in a list, that may matter to a few positions: see View::note.
struct SurveyNotes {
    using Numbers = CandidateList::Numbers;
    std::size_t count = 0;
    alignas(64) std::array<std::uint32_t, CandidateList::most + 64> place;
    alignas(64) Numbers need, away;  // square scene units
};

/// Candidates, by place in a list, with lower bounds of their squared distances from each of a few positions.
struct BoundRows {
    static constexpr std::size_t positions = 16;
    std::size_t count = 0;
    alignas(64) std::array<std::uint32_t, CandidateList::most + 64> place;
    alignas(64) std::array<float, (CandidateList::most + 64) * positions> bound;
};

}  // namespace astrosplat
