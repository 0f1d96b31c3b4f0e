// Boxes of clusters, as many at once as a vector has lanes.
#include "generate/cluster_filter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "generate/cluster_filter.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include <limits>

#include "core/append-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Boxes = hn::ScalableTag<float>;
using Lanes = hn::Vec<Boxes>;

void measure_boxes(ClusterList& list, const glm::vec3& point) {
    const Boxes d;
    const hn::RebindToUnsigned<Boxes> du;
    const auto beside = [&](const float* low, const float* high, float at) HWY_ATTR {
        const Lanes p = hn::Set(d, at);
        return hn::Max(hn::Max(hn::Sub(hn::Load(d, low), p), hn::Sub(p, hn::Load(d, high))), hn::Zero(d));
    };
    Lanes least = hn::Set(d, std::numeric_limits<float>::max());
    auto nearest = hn::Set(du, static_cast<std::uint32_t>(list.count)), number = counting(du);
    const auto sum = [](Lanes x, Lanes y, Lanes z)
                         HWY_ATTR { return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)); };
    for (std::size_t i = 0; i < list.count; i += hn::Lanes(d)) {
        const Lanes x = beside(&list.lo_x[i], &list.hi_x[i], point.x);
        const Lanes y = beside(&list.lo_y[i], &list.hi_y[i], point.y);
        const Lanes z = beside(&list.lo_z[i], &list.hi_z[i], point.z);
        hn::Store(sum(x, y, z), d, &list.squared[i]);
        const Lanes squared = sum(hn::Sub(hn::Load(d, &list.place_x[i]), hn::Set(d, point.x)),
                                  hn::Sub(hn::Load(d, &list.place_y[i]), hn::Set(d, point.y)),
                                  hn::Sub(hn::Load(d, &list.place_z[i]), hn::Set(d, point.z)));
        const auto nearer = hn::And(hn::Lt(squared, least), hn::FirstN(d, list.count - i));
        least = hn::IfThenElse(nearer, squared, least);
        nearest = hn::IfThenElse(hn::RebindMask(du, nearer), number, nearest);
        number = hn::Add(number, hn::Set(du, static_cast<std::uint32_t>(hn::Lanes(d))));
    }
    const auto lane = hn::FindFirstTrue(d, hn::Eq(least, hn::MinOfLanes(d, least)));
    list.nearest = hn::ExtractLane(nearest, static_cast<std::size_t>(lane));
}

std::size_t near_clusters(const ClusterList& list, float limit, std::uint32_t* places) {
    const Boxes d;
    const hn::RebindToUnsigned<Boxes> du;
    auto place = counting(du);
    std::size_t count = 0;
    for (std::size_t i = 0; i < list.count; i += hn::Lanes(d)) {
        const auto far = hn::Gt(hn::Load(d, &list.squared[i]), hn::Set(d, limit));
        const auto near = hn::AndNot(far, hn::FirstN(d, list.count - i));
        append(du, place, hn::RebindMask(du, near), places + count);
        count += hn::CountTrue(d, near);
        place = hn::Add(place, hn::Set(du, static_cast<std::uint32_t>(hn::Lanes(d))));
    }
    return count;
}

// Along one axis: the least of y^2 - 2 p y over p in low .. high and y in from .. to.
HWY_INLINE Lanes least(float low, float high, Lanes from, Lanes to) {
    const Boxes d;
    const auto end = [&](float p) HWY_ATTR {
        const Lanes y = hn::Min(hn::Max(hn::Set(d, p), from), to);
        return hn::Mul(y, hn::Sub(y, hn::Set(d, 2.0f * p)));
    };
    return hn::Min(end(low), end(high));
}

std::size_t filter_clusters(const ClusterList& list, float limit, const Bisectors& b,
                            std::uint32_t* numbers) {
    const Boxes d;
    const hn::RebindToUnsigned<Boxes> du;
    const auto axis = [&](const float* from, const float* to, float point, float low, float high) HWY_ATTR {
        const Lanes origin = hn::Set(d, point);
        return least(low, high, hn::Sub(hn::Load(d, from), origin), hn::Sub(hn::Load(d, to), origin));
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < list.count; i += hn::Lanes(d)) {
        const Lanes x = axis(&list.lo_x[i], &list.hi_x[i], b.point.x, b.low.x, b.high.x);
        const Lanes y = axis(&list.lo_y[i], &list.hi_y[i], b.point.y, b.low.y, b.high.y);
        const Lanes z = axis(&list.lo_z[i], &list.hi_z[i], b.point.z, b.low.z, b.high.z);
        const auto kept_away = hn::Gt(hn::Add(hn::Add(x, y), z), hn::Set(d, b.rounding));
        const auto far = hn::Gt(hn::Load(d, &list.squared[i]), hn::Set(d, limit));
        const auto near = hn::AndNot(hn::Or(kept_away, far), hn::FirstN(d, list.count - i));
        append(du, hn::Load(du, &list.cluster[i]), hn::RebindMask(du, near), numbers + count);
        count += hn::CountTrue(d, near);
    }
    return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(measure_boxes);
HWY_EXPORT(near_clusters);
HWY_EXPORT(filter_clusters);

void measure_boxes(ClusterList& list, const glm::vec3& point) {
    HWY_DYNAMIC_DISPATCH(measure_boxes)(list, point);
}

std::size_t near_clusters(const ClusterList& list, float limit, std::uint32_t* places) {
    return HWY_DYNAMIC_DISPATCH(near_clusters)(list, limit, places);
}

std::size_t filter_clusters(const ClusterList& list, float limit, const Bisectors& bisectors,
                            std::uint32_t* numbers) {
    return HWY_DYNAMIC_DISPATCH(filter_clusters)(list, limit, bisectors, numbers);
}

}  // namespace astrosplat
#endif
