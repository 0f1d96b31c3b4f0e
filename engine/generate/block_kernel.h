// The arithmetic of block queries, compiled once for every instruction set with the same bits on each. A
// block's 128 positions go in groups of sixteen neighbours (see block_places.h), so that one vector holds one
// coordinate of a group and a triangle is measured against all of them at once. In: the positions and the
// clusters around them. Out: closest points.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "generate/block_places.h"
#include "generate/candidates.h"
#include "generate/closest_point.h"

namespace astrosplat {

struct BlockMeasure {
    const ClusteredTriangle* triangles;  // all, by slot
    const TriangleCluster* clusters;     // all, by number
    glm::dvec3 origin;                   // of the candidates' coordinates
    float slack;                         // see ClosestPointIndex::slack, for all positions of the block
    double max_distance;                 // scene units
};

/// A thread's working memory: clusters where the block keeps none, the triangles that may be closest to one
/// of its positions, and what a group knows of those.
struct BlockScratch {
    std::vector<std::uint32_t> clusters;
    CandidateList chosen;
    SurveyNotes notes;
    BoundRows rows;
};

/// The clusters that may hold a triangle that is closest to one of the positions, and the slot of a triangle
/// that is probably near all of them.
struct BlockSurroundings {
    std::span<const std::uint32_t> clusters;  // at least one
    std::uint32_t near_slot;
};

/// Fills in the closest points: to the bits those of ClosestPointIndex::closest_brute_force. False when more
/// triangles can matter than `scratch` has room for.
bool measure_block(const BlockMeasure& measure, const BlockSurroundings& around, BlockScratch& scratch,
                   BlockAnswers& answers);

}  // namespace astrosplat
