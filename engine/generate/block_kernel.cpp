// The triangle that is near the block's middle is measured against all positions first, or just its middle.
// With what that leaves possible the block chooses the triangles of its clusters that can matter to it, and
// each group of sixteen positions does the same with those, after the one nearest to its own middle. Of the
// ones over which a group lies each position is measured against the one whose bound is lowest there. What
// that leaves of the others is little; it is measured where its bounds ask for it.
#include "generate/block_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "generate/block_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <span>

#include "generate/choose-inl.h"
#include "generate/closest_lanes-inl.h"
#include "generate/group_query-inl.h"
#include "generate/survey-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t block_groups = block_positions / group;

void to_local(const double* at, double origin, float* local) {
    for (std::size_t i = 0; i < block_positions; ++i) local[i] = static_cast<float>(at[i] - origin);
}

// All but the copies of the last in a cluster that has fewer than others.
std::size_t distinct(const TriangleCluster& cluster) {
    std::size_t count = TriangleCluster::size;
    while (count > 1 && cluster.slot[count - 1] == cluster.slot[count - 2]) --count;
    return count;
}

using GroupQueries = std::array<GroupQuery, block_groups>;

// False when more triangles can matter than there is room for.
bool measure_groups(const BlockMeasure& m, const BlockSurroundings& around, BlockScratch& scratch,
                    const BlockAnswers& answers, BlockPositions& local, GroupQueries& groups) {
    to_local(answers.x.data(), m.origin.x, local.x);
    to_local(answers.y.data(), m.origin.y, local.y);
    to_local(answers.z.data(), m.origin.z, local.z);
    constexpr std::uint32_t size = TriangleCluster::size;
    const TriangleBound reference = m.clusters[around.near_slot / size].bound(around.near_slot % size);
    const LocalPositions positions = local.part(0, block_positions);
    const PositionsBox box = box_around(positions, m.slack);
    // Of a triangle no larger than a part of the block, its middle says enough.
    const bool small = reference.radius < 0.5f * box.reach() && reference.normal != glm::vec3(0.0f);
    float widest = 0.0f;
    for (GroupQuery& g : groups) {
        if (small)
            g.expect(reference);
        else
            g.measure_first(around.near_slot);
        widest = std::max(widest, g.widest());
    }
    const View view(positions, box, reference, widest, m.slack);
    if (!choose(m, around.clusters, view, scratch.chosen)) return false;
    if (scratch.chosen.count == 0) return true;
    for (GroupQuery& g : groups) g.measure_chosen();
    return true;
}

bool measure_all(const BlockMeasure& m, const BlockSurroundings& around, BlockScratch& scratch,
                 BlockAnswers& answers) {
    alignas(64) double triangle[block_positions];
    const BestAnswers best{
        answers.x.data(), answers.y.data(), answers.z.data(), answers.distance_squared.data(),
        triangle,         answers.v.data(), answers.w.data()};
    answers.distance_squared.fill(m.max_distance * m.max_distance);
    std::fill_n(triangle, block_positions, static_cast<double>(ClosestPoint::none));
    answers.v.fill(0.0);
    answers.w.fill(0.0);

    BlockPositions local;
    Pairs pairs;
    const auto query = [&](std::size_t g)
                           HWY_ATTR { return GroupQuery(m, scratch, local, best, pairs, g * group); };
    GroupQueries groups{query(0), query(1), query(2), query(3), query(4), query(5), query(6), query(7)};
    constexpr std::size_t few = 3;  // triangles that are measured in less time than bounded
    const TriangleCluster& first = m.clusters[around.clusters[0]];
    const std::size_t all = distinct(first);
    if (around.clusters.size() == 1 && all <= few) {
        for (GroupQuery& g : groups) g.measure_all(first, all);
    } else if (!measure_groups(m, around, scratch, answers, local, groups)) {
        return false;
    }
    if (pairs.count > 0) offer_pairs(m.triangles, pairs, best);
    for (std::size_t i = 0; i < block_positions; ++i)
        answers.triangle[i] = static_cast<std::uint32_t>(triangle[i]);
    return true;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(measure_all);

bool measure_block(const BlockMeasure& measure, const BlockSurroundings& around, BlockScratch& scratch,
                   BlockAnswers& answers) {
    return HWY_DYNAMIC_DISPATCH(measure_all)(measure, around, scratch, answers);
}

}  // namespace astrosplat
#endif
