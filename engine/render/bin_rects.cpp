#include "render/bin_rects.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/bin_rects.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h has to come before highway.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VU = hn::Vec<DU>;
constexpr std::size_t lanes = hn::MaxLanes(D());
static_assert(lanes <= bin_rect_room + 1);

/// Bin at a place along one axis. Clamped first: rounding towards 0 is then floor.
HWY_INLINE VU bin_at(V px, V bins_per_px, V last) {
    const V inside = hn::Min(hn::Max(hn::Mul(px, bins_per_px), hn::Zero(D())), last);
    return hn::BitCast(DU(), hn::ConvertTo(DI(), inside));
}

/// Squares around `lanes` discs, px from the pyramid's corner.
struct Squares {
    V left, right, top, bottom, reach;
    HWY_INLINE Squares(const BinPyramid& pyramid, const Discs& discs, std::size_t i)
        : reach(hn::Load(D(), &discs.reach_px[i])) {
        const V x = hn::Sub(hn::Load(D(), &discs.x_px[i]), hn::Set(D(), pyramid.x0_px)),
                y = hn::Sub(hn::Load(D(), &discs.y_px[i]), hn::Set(D(), pyramid.y0_px));
        left = hn::Sub(x, reach);
        right = hn::Add(x, reach);
        top = hn::Sub(y, reach);
        bottom = hn::Add(y, reach);
    }
};

/// BinRect, `lanes` at once.
struct Rects {
    VU first_bin, columns, wide, high;
};

HWY_INLINE Rects rects_on(const BinLevel& level, float bins_per_px, const Squares& squares) {
    const V scale = hn::Set(D(), bins_per_px), last_column = hn::Set(D(), level.last_column),
            last_row = hn::Set(D(), level.last_row);
    const VU x = bin_at(squares.left, scale, last_column), y = bin_at(squares.top, scale, last_row),
             columns = hn::Set(DU(), level.columns), one = hn::Set(DU(), 1);
    return {hn::Add(hn::Add(hn::Set(DU(), level.first_bin), x), hn::Mul(y, columns)), columns,
            hn::Add(hn::Sub(bin_at(squares.right, scale, last_column), x), one),
            hn::Add(hn::Sub(bin_at(squares.bottom, scale, last_row), y), one)};
}

/// Sets `lanes` rects from those of the squares from i on.
HWY_INLINE void find_lanes(const BinPyramid& pyramid, const Discs& discs, std::size_t i, BinRect* rects) {
    const DU du;
    const Squares squares(pyramid, discs, i);
    Rects found{hn::Zero(du), hn::Zero(du), hn::Zero(du), hn::Zero(du)};
    auto missing = hn::Eq(found.wide, hn::Zero(du));
    float bin_px = pyramid.bin_px, bins_per_px = 1.0f / pyramid.bin_px;
    for (std::size_t l = 0; !hn::AllFalse(du, missing); ++l, bin_px *= 2.0f, bins_per_px *= 0.5f) {
        const bool is_last = l + 1 == pyramid.levels.size();
        const auto fits = hn::RebindMask(du, hn::Le(squares.reach, hn::Set(D(), bin_px)));
        const auto here = is_last ? missing : hn::And(missing, fits);
        missing = hn::AndNot(here, missing);
        if (hn::AllFalse(du, here)) continue;
        const Rects rects_here = rects_on(pyramid.levels[l], bins_per_px, squares);
        found.first_bin = hn::IfThenElse(here, rects_here.first_bin, found.first_bin);
        found.columns = hn::IfThenElse(here, rects_here.columns, found.columns);
        found.wide = hn::IfThenElse(here, rects_here.wide, found.wide);
        found.high = hn::IfThenElse(here, rects_here.high, found.high);
    }
    static_assert(sizeof(BinRect) == 4 * sizeof(std::uint32_t));
    hn::StoreInterleaved4(found.first_bin, found.columns, found.wide, found.high, du, &rects->first_bin);
}

void find_bins_here(const BinPyramid& pyramid, const Discs& discs, std::size_t count, BinRect* rects) {
    for (std::size_t i = 0; i < count; i += lanes) find_lanes(pyramid, discs, i, rects + i);
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(find_bins_here);

void find_bins(const BinPyramid& pyramid, const Discs& discs, std::size_t count, BinRect* rects) {
    assert(!pyramid.levels.empty());
    HWY_DYNAMIC_DISPATCH(find_bins_here)(pyramid, discs, count, rects);
}

}  // namespace astrosplat
#endif  // HWY_ONCE
