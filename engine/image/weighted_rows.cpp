#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/weighted_rows.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include "image/blur.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void weighted_rows_here(std::span<const float> weights, std::span<const float* const> rows,
                        std::int64_t count, float* out) {
    const hn::ScalableTag<float> d;
    const auto lanes = std::int64_t(hn::Lanes(d));
    std::int64_t i = 0;
    // Four at a time share the loads of weights and pointers.
    for (; i + 4 * lanes <= count; i += 4 * lanes) {
        auto a = hn::Zero(d), b = a, c = a, e = a;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const auto weight = hn::Set(d, weights[k]);
            const float* const row = rows[k] + i;
            a = hn::Add(a, hn::Mul(weight, hn::LoadU(d, row)));
            b = hn::Add(b, hn::Mul(weight, hn::LoadU(d, row + lanes)));
            c = hn::Add(c, hn::Mul(weight, hn::LoadU(d, row + 2 * lanes)));
            e = hn::Add(e, hn::Mul(weight, hn::LoadU(d, row + 3 * lanes)));
        }
        hn::StoreU(a, d, out + i);
        hn::StoreU(b, d, out + i + lanes);
        hn::StoreU(c, d, out + i + 2 * lanes);
        hn::StoreU(e, d, out + i + 3 * lanes);
    }
    for (; i + lanes <= count; i += lanes) {
        auto sum = hn::Zero(d);
        for (std::size_t k = 0; k < weights.size(); ++k)
            sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, rows[k] + i)));
        hn::StoreU(sum, d, out + i);
    }
    for (; i < count; ++i) {
        float sum = 0.0f;
        for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * rows[k][i];
        out[i] = sum;
    }
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(weighted_rows_here);

void weighted_rows(std::span<const float> weights, std::span<const float* const> rows, std::int64_t count,
                   float* out) {
    HWY_DYNAMIC_DISPATCH(weighted_rows_here)(weights, rows, count, out);
}

}  // namespace astrosplat
#endif  // HWY_ONCE
