// The types of shaders/shared as vectors of lanes, so that what it holds compiles for many splats at once:
// Lanes, LaneInts and LaneBools over a Highway tag of floats. Included once per instruction set.
#if defined(ASTROSPLAT_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_LANES_INL_H
#undef ASTROSPLAT_LANES_INL_H
#else
#define ASTROSPLAT_LANES_INL_H
#endif

#include <hwy/highway.h>

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

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
