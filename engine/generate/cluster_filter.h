// Which clusters of a list matter to a block, by their boxes alone. In: the boxes, a point or what a block
// knows. Out: distances, or the numbers of the clusters that are left. Vector code; it only proposes, so
// nothing here reaches a result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "generate/candidates.h"

namespace astrosplat {

/// Fills in list.squared, at most the squared distances of the boxes from a point in their coordinates, and
/// list.nearest.
void measure_boxes(ClusterList& list, const glm::vec3& point);

/// To `places`, which has room for ClusterList::most + 64: the places in the list of the clusters whose boxes
/// are within the root of `limit` by list.squared. Returns how many.
std::size_t near_clusters(const ClusterList& list, float limit, std::uint32_t* places);

/// A point y can only be closer to a position p than the meshes' point c if it is on p's side of the plane
/// midway between y and c: with y and p relative to c, if y^2 - 2 p y <= 0. Over p in a box with middle m and
/// half sides h, the least of that is a sum over the axes of y^2 - 2 m y - 2 h |y|, and over y in a box as
/// well each axis has its own least.
struct Bisectors {
    glm::vec3 point;      // c, in the boxes' coordinates
    glm::vec3 low, high;  // of the positions' box, relative to c
    float rounding;  // square scene units: what such a sum must exceed; infinite where c is not to be used
};

/// To `numbers`, which has room for ClusterList::most + 64: the clusters whose boxes are within the root of
/// `limit` by list.squared and may hold a point that is closer than c. Returns how many.
std::size_t filter_clusters(const ClusterList& list, float limit, const Bisectors& bisectors,
                            std::uint32_t* numbers);

}  // namespace astrosplat
