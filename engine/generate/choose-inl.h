// Which triangles of some clusters can matter to a few positions. In: clusters, and the positions' view. Out:
// a list of candidates. Included once per instruction set.
#if defined(ASTROSPLAT_SPLATS_CHOOSE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_SPLATS_CHOOSE_INL_H
#undef ASTROSPLAT_SPLATS_CHOOSE_INL_H
#else
#define ASTROSPLAT_SPLATS_CHOOSE_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "generate/block_kernel.h"
#include "generate/survey-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Triangles of clusters, as many as a vector has lanes.
struct ClusterLanes {
    BoundLanes bounds;
    hn::Vec<ManyNumbers> slots;
};

// From the i-th triangle of some clusters on: of one cluster, or of it and the next.
HWY_INLINE ClusterLanes lanes_of(const TriangleCluster* all, const std::uint32_t* numbers, std::size_t i) {
    constexpr std::size_t size = TriangleCluster::size;
    const Many d;
    const ManyNumbers du;
    const TriangleCluster& one = all[numbers[i / size]];
#if HWY_TARGET <= HWY_AVX3
    static_assert(hn::MaxLanes(Many()) == 2 * size);
    const TriangleCluster& two = all[numbers[i / size + 1]];
    const auto load = [](auto tag, const auto& first, const auto& second) HWY_ATTR {
        const hn::Half<decltype(tag)> half;
        return hn::Combine(tag, hn::LoadU(half, second.data()), hn::LoadU(half, first.data()));
    };
#else
    const TriangleCluster& two = one;
    const auto load = [&](auto tag, const auto& values, const auto&)
                          HWY_ATTR { return hn::LoadU(tag, &values[i % size]); };
#endif
    return {{load(d, one.center_x, two.center_x), load(d, one.center_y, two.center_y),
             load(d, one.center_z, two.center_z), load(d, one.normal_x, two.normal_x),
             load(d, one.normal_y, two.normal_y), load(d, one.normal_z, two.normal_z),
             load(d, one.radius, two.radius)},
            load(du, one.slot, two.slot)};
}

// At the end of the list, the lanes in `mask`; there is room for a whole vector.
HWY_INLINE void append_candidates(const ClusterLanes& lanes, hn::Mask<Many> mask, CandidateList& to) {
    const Many d;
    const ManyNumbers du;
    const BoundLanes& b = lanes.bounds;
    const auto copy = [&](Lanes values, CandidateList::Numbers& array)
                          HWY_ATTR { append(d, values, mask, &array[to.count]); };
    append(du, lanes.slots, hn::RebindMask(du, mask), &to.slot[to.count]);
    copy(b.center_x, to.center_x), copy(b.center_y, to.center_y), copy(b.center_z, to.center_z);
    copy(b.normal_x, to.normal_x), copy(b.normal_y, to.normal_y), copy(b.normal_z, to.normal_z);
    copy(b.radius, to.radius);
    to.count += hn::CountTrue(d, mask);
}

// Most edges of the list's triangles will be needed soon.
void prefetch_edges(const ClusteredTriangle* triangles, const CandidateList& list) {
    for (std::size_t i = 0; i < list.count; ++i) {
        const TriangleEdges& edges = triangles[list.slot[i]].edges;
        __builtin_prefetch(edges.normal_x.data()), __builtin_prefetch(&edges.offset[2]);
    }
}

// To `chosen`, the triangles of the clusters that can matter to the view; false when they do not fit.
bool choose(const BlockMeasure& m, std::span<const std::uint32_t> clusters, const View& view,
            CandidateList& chosen) {
    const Many d;
    const std::size_t count = clusters.size() * TriangleCluster::size;
    const std::uint32_t last_twice[2] = {clusters.back(), clusters.back()};
    chosen.count = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const bool whole = i + hn::Lanes(d) <= count;
        const ClusterLanes lanes = lanes_of(m.clusters, whole ? clusters.data() : last_twice, whole ? i : 0);
        const View::Note n = view.note(lanes.bounds);
        const auto taken = hn::And(view.matter(n.need, n.away), hn::FirstN(d, count - i));
        if (hn::AllFalse(d, taken)) continue;
        if (chosen.count + hn::Lanes(d) > CandidateList::most) return false;
        append_candidates(lanes, taken, chosen);
    }
    prefetch_edges(m.triangles, chosen);
    return true;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#endif  // toggle
