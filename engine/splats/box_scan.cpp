// The scan over boxes, compiled once for every instruction set.
#include "splats/box_scan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splats/box_scan.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void scan(const BoxList& boxes, const glm::vec3& p, float limit, NearBoxes& found) {
    const hn::ScalableTag<float> df;
    const hn::RebindToUnsigned<decltype(df)> du;
    const auto outside = [&](const float* lo, const float* hi, float at) HWY_ATTR {
        const auto x = hn::Set(df, at);
        return hn::Max(hn::Max(hn::Sub(hn::LoadU(df, lo), x), hn::Sub(x, hn::LoadU(df, hi))), hn::Zero(df));
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < boxes.count; i += hn::Lanes(df)) {
        const auto x = outside(&boxes.lo_x[i], &boxes.hi_x[i], p.x);
        const auto y = outside(&boxes.lo_y[i], &boxes.hi_y[i], p.y);
        const auto z = outside(&boxes.lo_z[i], &boxes.hi_z[i], p.z);
        const auto squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
        const auto near_p = hn::And(hn::Le(squared, hn::Set(df, limit)), hn::FirstN(df, boxes.count - i));
        if (hn::AllFalse(df, near_p)) continue;
        const auto places = hn::Iota(du, static_cast<std::uint32_t>(i));
        hn::CompressStore(squared, near_p, df, &found.squared[count]);
        count += hn::CompressStore(places, hn::RebindMask(du, near_p), du, &found.place[count]);
    }
    found.count = count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(scan);

void find_near_boxes(const BoxList& boxes, const glm::vec3& p, float limit, NearBoxes& found) {
    HWY_DYNAMIC_DISPATCH(scan)(boxes, p, limit, found);
}

}  // namespace astrosplat
#endif
