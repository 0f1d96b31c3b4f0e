// Vectors of lanes: the types of shaders/shared over a Highway tag of floats, so that what it holds compiles
// for many splats at once; lanes that a mask picks, one after the other in memory; masks as bits. Included
// once per instruction set.
#if defined(ASTROSPLAT_CORE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_CORE_LANES_INL_H
#undef ASTROSPLAT_CORE_LANES_INL_H
#else
#define ASTROSPLAT_CORE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct LaneBools {
    hn::Mask<D> m;
    HWY_INLINE LaneBools(hn::Mask<D> mask) : m(mask) {}
    HWY_INLINE friend LaneBools operator&&(LaneBools a, LaneBools b) { return hn::And(a.m, b.m); }
    HWY_INLINE friend LaneBools operator!(LaneBools a) { return hn::Not(a.m); }
    HWY_INLINE friend LaneBools operator||(LaneBools a, LaneBools b) { return hn::Or(a.m, b.m); }
};

template <class D>
struct LaneInts {
    using DI = hn::RebindToSigned<D>;
    hn::Vec<DI> v;
    HWY_INLINE LaneInts(hn::Vec<DI> values) : v(values) {}
    HWY_INLINE LaneInts(int value) : v(hn::Set(DI(), value)) {}
    HWY_INLINE friend LaneInts operator-(LaneInts a, LaneInts b) { return hn::Sub(a.v, b.v); }
    HWY_INLINE friend LaneInts operator&(LaneInts a, LaneInts b) { return hn::And(a.v, b.v); }
    HWY_INLINE friend LaneInts operator>>(LaneInts a, int bits) { return hn::ShiftRightSame(a.v, bits); }
    HWY_INLINE friend LaneInts min(LaneInts a, LaneInts b) { return hn::Min(a.v, b.v); }
    HWY_INLINE friend LaneInts max(LaneInts a, LaneInts b) { return hn::Max(a.v, b.v); }
    HWY_INLINE friend LaneBools<D> operator==(LaneInts a, LaneInts b) {
        return hn::RebindMask(D(), hn::Eq(a.v, b.v));
    }
    HWY_INLINE friend LaneBools<D> operator<(LaneInts a, LaneInts b) {
        return hn::RebindMask(D(), hn::Lt(a.v, b.v));
    }
};

template <class D>
struct Lanes {
    hn::Vec<D> v;
    HWY_INLINE Lanes(hn::Vec<D> values) : v(values) {}
    HWY_INLINE Lanes(float value) : v(hn::Set(D(), value)) {}
    HWY_INLINE explicit Lanes(LaneInts<D> values) : v(hn::ConvertTo(D(), values.v)) {}
    HWY_INLINE Lanes operator-() const { return hn::Neg(v); }
    HWY_INLINE friend Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v, b.v); }
    HWY_INLINE friend Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v, b.v); }
    HWY_INLINE friend Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v, b.v); }
    HWY_INLINE friend Lanes operator/(Lanes a, Lanes b) { return hn::Div(a.v, b.v); }
    HWY_INLINE friend Lanes as_div(Lanes a, Lanes b) { return hn::Div(a.v, b.v); }
    HWY_INLINE friend LaneBools<D> operator<(Lanes a, Lanes b) { return hn::Lt(a.v, b.v); }
    HWY_INLINE friend LaneBools<D> operator<=(Lanes a, Lanes b) { return hn::Le(a.v, b.v); }
    HWY_INLINE friend LaneBools<D> operator>(Lanes a, Lanes b) { return hn::Gt(a.v, b.v); }
    HWY_INLINE friend Lanes min(Lanes a, Lanes b) { return hn::Min(a.v, b.v); }
    HWY_INLINE friend Lanes max(Lanes a, Lanes b) { return hn::Max(a.v, b.v); }
    HWY_INLINE friend Lanes abs(Lanes a) { return hn::Abs(a.v); }
    HWY_INLINE friend Lanes sqrt(Lanes a) { return hn::Sqrt(a.v); }
    HWY_INLINE friend Lanes floor(Lanes a) { return hn::Floor(a.v); }
    HWY_INLINE friend Lanes mix(Lanes a, Lanes b, LaneBools<D> take_b) {
        return hn::IfThenElse(take_b.m, b.v, a.v);
    }
    HWY_INLINE friend LaneInts<D> floatBitsToInt(Lanes a) {
        return hn::BitCast(hn::RebindToSigned<D>(), a.v);
    }
};

template <class D>
struct LaneVectors {
    Lanes<D> x, y, z;
    HWY_INLINE friend Lanes<D> dot(LaneVectors a, LaneVectors b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

namespace {

/// 0, 1, 2 ... (Highway 1.0.3's Iota fills an array each time.)
template <class D>
HWY_INLINE hn::Vec<D> counting(D d) {
    alignas(64) static constexpr std::uint32_t numbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                              8, 9, 10, 11, 12, 13, 14, 15};
    static_assert(hn::MaxLanes(D()) <= 16);
    return hn::Load(d, numbers);
}

/// Lane 0 is the lowest bit.
template <class D, class Mask>
HWY_INLINE unsigned bits_of(D d, Mask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    static_assert(hn::MaxLanes(D()) <= 16);
    return bytes[0] | unsigned(bytes[1]) << 8;
}

#if HWY_TARGET == HWY_AVX2
using PickedLanes = std::array<std::array<std::uint8_t, 8>, 256>;

// Of each mask of eight lanes, as bits: the numbers of its lanes, then zeros. A constant in bytes, for
// Highway 1.0.3's own Compress copies a table to the stack in each call before AVX-512.
constexpr PickedLanes make_picked_lanes() {
    PickedLanes picked{};
    for (unsigned mask = 0; mask < picked.size(); ++mask) {
        std::size_t count = 0;
        for (std::uint8_t lane = 0; lane < 8; ++lane)
            if (mask >> lane & 1u) picked[mask][count++] = lane;
    }
    return picked;
}
constexpr PickedLanes picked_lanes = make_picked_lanes();
#endif

/// Writes the lanes in `mask` one after the other to `to`, which has room for a whole vector more.
template <class D, class Mask>
HWY_INLINE void append(D d, hn::Vec<D> values, Mask mask, hn::TFromD<D>* to) {
    static_assert(sizeof(hn::TFromD<D>) == 4);
#if HWY_TARGET <= HWY_AVX3
    hn::StoreU(hn::Compress(values, mask), d, to);
#elif HWY_TARGET == HWY_AVX2
    const auto lanes = hn::LoadU(hn::Rebind<std::uint8_t, D>(), picked_lanes[bits_of(d, mask)].data());
    const auto indices = hn::IndicesFromVec(d, hn::PromoteTo(hn::RebindToUnsigned<D>(), lanes));
    hn::StoreU(hn::TableLookupLanes(values, indices), d, to);
#else
    alignas(16) hn::TFromD<D> from[hn::MaxLanes(D())];
    hn::Store(values, d, from);
    for (unsigned bits = bits_of(d, mask); bits != 0; bits &= bits - 1) *to++ = from[std::countr_zero(bits)];
#endif
}

}  // namespace
}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
