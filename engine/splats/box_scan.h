// A short list of triangles with a box around each, and the vectorised question which boxes come near a
// point. The answer only proposes: it may name a box too many, never one too few, and so reaches no result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace astrosplat {

/// Boxes as arrays; coordinates are relative to a point nearby, so that float is enough.
struct BoxList {
    static constexpr std::size_t most = 2048;
    static constexpr std::size_t room = most + 64;  // whole vectors are read and written at the end
    template <class T>
    using Array = std::array<T, room>;

    std::size_t count = 0;
    Array<std::uint32_t> triangle;
    Array<float> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;

    void add(std::uint32_t number, const glm::vec3& lo, const glm::vec3& hi) {
        triangle[count] = number;
        lo_x[count] = lo.x, lo_y[count] = lo.y, lo_z[count] = lo.z;
        hi_x[count] = hi.x, hi_y[count] = hi.y, hi_z[count] = hi.z;
        ++count;
    }
};

/// Places in a BoxList, ascending, and how far those boxes are.
struct NearBoxes {
    std::size_t count = 0;
    BoxList::Array<std::uint32_t> place;
    BoxList::Array<float> squared;  // square scene units
};

/// Finds the boxes whose squared distance from p is at most `limit`.
void find_near_boxes(const BoxList& boxes, const glm::vec3& p, float limit, NearBoxes& found);

}  // namespace astrosplat
