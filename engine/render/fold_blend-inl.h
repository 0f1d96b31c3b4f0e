// Vector code of the fold's innermost loop: a splat's weight at the pixels of a block, and the blends.
// Included once per instruction set.
#if defined(ASTROSPLAT_FOLD_BLEND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_FOLD_BLEND_INL_H
#undef ASTROSPLAT_FOLD_BLEND_INL_H
#else
#define ASTROSPLAT_FOLD_BLEND_INL_H
#endif

#include <hwy/highway.h>

#include <type_traits>

#include "core/shared_maths.h"
#include "render/fold_batch.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

namespace lane_maths {  // the shared maths, compiled for this instruction set
namespace {
using namespace astrosplat::glsl;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "maths.glsl"
#pragma GCC diagnostic pop
}  // namespace
}  // namespace lane_maths

using D = hn::CappedTag<float, TilePlanes::block_pixels>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;
constexpr int lanes = int(hn::MaxLanes(D()));
constexpr int segments = FootprintNode::segments;

HWY_INLINE V load(const float* p) { return hn::Load(D(), p); }
HWY_INLINE void store(V v, float* p) { hn::Store(v, D(), p); }
HWY_INLINE void accumulate(float* p, V v) { store(hn::Add(load(p), v), p); }
HWY_INLINE V all(float v) { return hn::Set(D(), v); }
HWY_INLINE V clamp_one(V v) { return hn::Min(v, all(1.0f)); }
HWY_INLINE V clamp_zero(V v) { return hn::Max(v, hn::Zero(D())); }
HWY_INLINE V saturate(V v) { return clamp_one(clamp_zero(v)); }

/// One of sixteen coefficients per lane, by the lowest four bits of `segment`.
HWY_INLINE V look_up(const float* c, VI segment) {
    // Permutes across a whole vector ignore higher bits by themselves; only Highway's own debug checks
    // do not.
    constexpr bool ignores_high_bits = lanes >= 8 && !HWY_IS_DEBUG_BUILD;
    const VI low = ignores_high_bits ? segment : hn::And(segment, hn::Set(DI(), lanes - 1));
    const auto index = hn::IndicesFromVec(D(), low);
    V r = hn::TableLookupLanes(load(c), index);
    if constexpr (lanes * 2 == segments) {  // the fourth bit, as a sign
        const V upper = hn::TableLookupLanes(load(c + lanes), index);
        r = hn::IfNegativeThenElse(hn::BitCast(D(), hn::ShiftLeft<28>(segment)), upper, r);
    } else if constexpr (lanes < segments) {
        const VI whole = hn::And(segment, hn::Set(DI(), segments - 1));
        for (int i = 1; i < segments / lanes; ++i) {
            const auto here = hn::RebindMask(D(), hn::Gt(whole, hn::Set(DI(), i * lanes - 1)));
            r = hn::IfThenElse(here, hn::TableLookupLanes(load(c + i * lanes), index), r);
        }
    }
    return r;
}

// The chain of operations from a splat to a pixel is long, and a core does not look ahead over enough of them
// to keep its units busy. So two vectors go side by side, and the next two begin before these end: two splats
// where a block's pixels are one vector, else two vectors of pixels, which share what is read of their splat.
constexpr int sides = 2;
constexpr int parts = lanes == TilePlanes::block_pixels ? 1 : sides;
constexpr std::size_t part_of(int side) { return parts == 1 ? 0 : std::size_t(side); }

/// Some of a block's pixels: those of one vector or two.
struct BlockPart {
    V x_px[parts], y_px[parts];  // of the whole frame
    V toward[3][parts];          // onto the sphere: the pixels' directions, of length focal_px
    std::size_t at;              // in the planes
};

/// Splats on their way to be folded into pixels: which, and where in their cubics the pixels are.
struct SplatsUnderway {
    int i[sides];
    V segment[sides];  // its number in the lowest bits of the float
    V place[sides];    // in the segment, 0 to 1
};

constexpr float to_whole = 12582912.0f;  // 1.5 * 2^23: a number added to it is rounded to a whole one

/// Squared distance in the plane of the round footprint.
template <Outline kOutline>
HWY_INLINE V squared_length(const SplatBatch& batch, int i, V dx, V dy) {
    if constexpr (kOutline == Outline::shaped) {
        const V xy = all(batch.map_xy[i]);
        const V x = hn::Add(hn::Mul(all(batch.map_xx[i]), dx), hn::Mul(xy, dy));
        dy = hn::Add(hn::Mul(xy, dx), hn::Mul(all(batch.map_yy[i]), dy));
        dx = x;
    }
    return hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
}

/// Squared chord to splat i.
HWY_INLINE V squared_chord(const SplatBatch& batch, int i, const BlockPart& part, std::size_t p) {
    V sum = hn::Zero(D());
    for (int k = 0; k < 3; ++k) {
        const V d = hn::Sub(part.toward[k][p], all(batch.toward[k][i]));
        sum = hn::Add(sum, hn::Mul(d, d));
    }
    return sum;
}

/// Squared distance on the map around splat i, in the plane of the round footprint (SphereFootprint): what
/// lies across its direction, longer by what a chord is longer than its share across.
HWY_INLINE V squared_on_map(const SplatBatch& batch, int i, const BlockPart& part, std::size_t p, V chord) {
    V sum = hn::Zero(D());
    for (const auto& row : batch.row) {
        V along = hn::Zero(D());
        for (int k = 0; k < 3; ++k)
            along =
                hn::Add(along, hn::Mul(all(row[k][i]), hn::Sub(part.toward[k][p], all(batch.toward[k][i]))));
        sum = hn::Add(sum, hn::Mul(along, along));
    }
    const V half_cosine = hn::Sub(all(1.0f), hn::Mul(chord, all(batch.per_square)));  // squared
    return hn::Div(sum, hn::Max(half_cosine, all(1e-6f)));
}

/// Takes the next splats out of `bits` (with none left, SplatBatch::none).
template <Outline kOutline>
HWY_INLINE SplatsUnderway begin_splats(const SplatBatch& batch, SplatBits& bits, const BlockPart& part) {
    SplatsUnderway to;
    V u[sides];
    for (int n = 0; n < sides; ++n) to.i[n] = n == 0 || parts == 1 ? bits.take_first() : to.i[0];
    for (int n = 0; n < sides; ++n) {
        const int i = to.i[n];
        if constexpr (is_onto_sphere(kOutline)) {
            u[n] = squared_chord(batch, i, part, part_of(n));
            if constexpr (kOutline == Outline::sphere_shaped)
                if (batch.shaped[i]) u[n] = squared_on_map(batch, i, part, part_of(n), u[n]);
        } else {
            const V dx = hn::Sub(part.x_px[part_of(n)], all(batch.x_px[i])),
                    dy = hn::Sub(part.y_px[part_of(n)], all(batch.y_px[i]));
            u[n] = squared_length<kOutline>(batch, i, dx, dy);
        }
        if (batch.linear_in_distance[i]) u[n] = hn::Sqrt(u[n]);
        if (kOutline != Outline::soft) u[n] = hn::Sub(u[n], all(batch.lo[i]));
        u[n] = hn::Mul(u[n], all(batch.scale[i]));
        if (kOutline != Outline::soft) u[n] = clamp_zero(u[n]);
    }
    // On a segment's end either side will do. Far outside, both are nonsense that end_splats takes away.
    for (int n = 0; n < sides; ++n) to.segment[n] = hn::Sub(u[n], all(0.5f));
    for (int n = 0; n < sides; ++n) to.segment[n] = hn::Add(to.segment[n], all(to_whole));
    for (int n = 0; n < sides; ++n) to.place[n] = hn::Sub(u[n], hn::Sub(to.segment[n], all(to_whole)));
    return to;
}

/// Their weights at the pixels, without the amplitudes. Not clamped: the cubics may leave [0, 1] by a
/// few 1e-5.
template <Outline kOutline>
HWY_INLINE void end_splats(const SplatBatch& batch, const SplatsUnderway& from, V (&w)[sides]) {
    const auto coefficient = [&](int n, int power) {
        return look_up(batch.cubic[from.i[n]][power], hn::BitCast(DI(), from.segment[n]));
    };
    for (int n = 0; n < sides; ++n) w[n] = coefficient(n, 3);
    for (int power = 2; power >= 0; --power) {
        for (int n = 0; n < sides; ++n) w[n] = hn::Mul(w[n], from.place[n]);
        for (int n = 0; n < sides; ++n) w[n] = hn::Add(w[n], coefficient(n, power));
    }
    const V outside = all(to_whole + float(segments));
    for (int n = 0; n < sides; ++n) {
        w[n] = hn::IfThenElseZero(hn::Lt(from.segment[n], outside), w[n]);
        if (kOutline != Outline::soft)
            w[n] = hn::Add(w[n],
                           hn::Mul(all(batch.edge_gain[from.i[n]]), hn::Mul(w[n], hn::Sub(all(1.0f), w[n]))));
    }
}

/// Inputs of a blend besides weights: the splat, and where its layer keeps its light at these pixels.
struct FoldStep {
    const SplatBatch& batch;
    int i;                  // of the splat in the batch
    float* layer_light[4];  // with AOVs only
};

// Each blend holds the state of `lanes` pixels in registers. Transmittances run on below the stop threshold,
// where the pixel is closed: they never grow, so "closed" is a comparison that no later splat has to wait
// for. close() makes them exactly 0.

/// Over: one transmittance.
struct OverPixels {
    static constexpr bool closes = true, aovs = false, general = false;
    V color[3], alpha, t;

    HWY_INLINE OverPixels(const TilePlanes& p, std::size_t i) : alpha(load(&p.alpha[i])) {
        for (int k = 0; k < 3; ++k) color[k] = load(&p.color[k][i]);
        t = load(&p.transmittance[0][i]);
    }
    HWY_INLINE void store_to(TilePlanes& p, std::size_t i) const {
        for (int k = 0; k < 3; ++k) store(color[k], &p.color[k][i]);
        store(alpha, &p.alpha[i]);
        store(t, &p.transmittance[0][i]);
    }
    HWY_INLINE M open(V stop) const { return hn::Ge(t, stop); }
    template <bool kMayClose>
    HWY_INLINE void fold(const FoldStep& step, V s, V, V stop) {
        V share = hn::Mul(t, s);
        if (kMayClose) share = hn::IfThenElseZero(open(stop), share);
        for (int k = 0; k < 3; ++k)
            color[k] = hn::Add(color[k], hn::Mul(share, all(step.batch.color[k][step.i])));
        alpha = hn::Add(alpha, share);
        t = hn::Mul(t, hn::Sub(all(1.0f), s));
    }
    HWY_INLINE void close(V stop) {
        const M is_open = open(stop);
        alpha = hn::IfThenElse(is_open, alpha, all(1.0f));
        t = hn::IfThenElseZero(is_open, t);
    }
};

/// Add: nothing hides anything, and alpha is not kept.
struct AddPixels {
    static constexpr bool closes = false, aovs = false, general = false;
    V color[3];

    HWY_INLINE AddPixels(const TilePlanes& p, std::size_t i) {
        for (int k = 0; k < 3; ++k) color[k] = load(&p.color[k][i]);
    }
    HWY_INLINE void store_to(TilePlanes& p, std::size_t i) const {
        for (int k = 0; k < 3; ++k) store(color[k], &p.color[k][i]);
    }
    HWY_INLINE M open(V stop) const { return hn::Eq(stop, stop); }
    template <bool>
    HWY_INLINE void fold(const FoldStep& step, V s, V, V) {
        for (int k = 0; k < 3; ++k)
            color[k] = hn::Add(color[k], hn::Mul(s, all(step.batch.color[k][step.i])));
    }
};

/// Depth, coverage and count alongside a blend.
struct AovPixels {
    V depth_sum, uncovered, count;

    HWY_INLINE AovPixels(const TilePlanes& p, std::size_t i)
        : depth_sum(load(&p.depth_sum[i])), uncovered(load(&p.uncovered[i])), count(load(&p.count[i])) {}
    HWY_INLINE void store_to(TilePlanes& p, std::size_t i) const {
        store(depth_sum, &p.depth_sum[i]);
        store(uncovered, &p.uncovered[i]);
        store(count, &p.count[i]);
    }
    HWY_INLINE void fold(const FoldStep& step, V s, V weight, V alpha_share, M open) {
        depth_sum = hn::Add(depth_sum, hn::Mul(alpha_share, all(step.batch.depth[step.i])));
        const M touched = hn::And(hn::Gt(s, hn::Zero(D())), open);
        count = hn::Add(count, hn::IfThenElseZero(touched, all(1.0f)));
        const V rest = hn::Mul(uncovered, hn::Sub(all(1.0f), saturate(weight)));
        uncovered = hn::IfThenElse(touched, rest, uncovered);
    }
};
struct NoAovPixels {
    HWY_INLINE NoAovPixels(const TilePlanes&, std::size_t) {}
    HWY_INLINE void store_to(TilePlanes&, std::size_t) const {}
    HWY_INLINE void fold(const FoldStep&, V, V, V, M) {}
};
template <bool kAovs>
using Aovs = std::conditional_t<kAovs, AovPixels, NoAovPixels>;

/// Lighten: the brightest splat per channel.
template <bool kAovs>
struct LightenPixels {
    static constexpr bool closes = false, aovs = kAovs, general = false;
    V color[3], alpha, t;
    Aovs<kAovs> more;

    HWY_INLINE LightenPixels(const TilePlanes& p, std::size_t i)
        : alpha(load(&p.alpha[i])), t(load(&p.transmittance[3][i])), more(p, i) {
        for (int k = 0; k < 3; ++k) color[k] = load(&p.color[k][i]);
    }
    HWY_INLINE void store_to(TilePlanes& p, std::size_t i) const {
        for (int k = 0; k < 3; ++k) store(color[k], &p.color[k][i]);
        store(alpha, &p.alpha[i]);
        store(t, &p.transmittance[3][i]);
        more.store_to(p, i);
    }
    HWY_INLINE M open(V stop) const { return hn::Eq(stop, stop); }
    template <bool>
    HWY_INLINE void fold(const FoldStep& step, V s, V weight, V) {
        for (int k = 0; k < 3; ++k)
            color[k] = hn::Max(color[k], hn::Mul(s, all(step.batch.color[k][step.i])));
        const V share = hn::Mul(t, s);
        alpha = hn::Add(alpha, share);
        t = hn::Mul(t, hn::Sub(all(1.0f), s));
        more.fold(step, s, weight, share, hn::Eq(s, s));
    }
};

/// blend_absorbed() of r, g and b with one logarithm, s in [0, 1]. Plain loops, which become vectors.
HWY_FLATTEN inline void absorb(const SplatBatch& batch, int i, V s, V (&hidden)[4]) {
    alignas(64) float rest[lanes], log[lanes], through[lanes];
    store(hn::Sub(all(1.0f), s), rest);
    for (int n = 0; n < lanes; ++n) log[n] = lane_maths::as_log(rest[n]);
    for (int k = 0; k < 3; ++k) {
        const float exponent = batch.occlusion[k][i];
        if (exponent == 1.0f) {
            hidden[k] = hn::Sub(all(1.0f), load(rest));
            continue;
        }
        for (int n = 0; n < lanes; ++n) through[n] = lane_maths::as_exp(exponent * log[n]);
        hidden[k] = hn::Sub(all(1.0f), load(through));
    }
}

/// Any mix of the affine blends. kHolds: there are holdouts, whose alpha is taken away.
template <bool kAovs, bool kHolds>
struct GeneralPixels {
    static constexpr bool closes = true, aovs = kAovs, general = true;
    V color[3], alpha, held, t[4];
    Aovs<kAovs> more;

    HWY_INLINE GeneralPixels(const TilePlanes& p, std::size_t i)
        : alpha(load(&p.alpha[i])), held(load(&p.held[i])), more(p, i) {
        for (int k = 0; k < 3; ++k) color[k] = load(&p.color[k][i]);
        for (int k = 0; k < 4; ++k) t[k] = load(&p.transmittance[k][i]);
    }
    HWY_INLINE void store_to(TilePlanes& p, std::size_t i) const {
        for (int k = 0; k < 3; ++k) store(color[k], &p.color[k][i]);
        for (int k = 0; k < 4; ++k) store(t[k], &p.transmittance[k][i]);
        store(alpha, &p.alpha[i]);
        if (kHolds) store(held, &p.held[i]);
        more.store_to(p, i);
    }
    HWY_INLINE M open(V stop) const {
        return hn::Ge(hn::Max(hn::Max(t[0], t[1]), hn::Max(t[2], t[3])), stop);
    }
    template <bool kMayClose>
    HWY_INLINE void fold(const FoldStep& step, V s, V weight, V stop) {
        const Hiding hiding = step.batch.hiding[step.i];
        if (hiding == Hiding::plain) {
            const V hidden[4] = {s, s, s, s};
            return fold_hidden<kMayClose>(step, s, weight, stop, hidden);
        }
        V hidden[4];
        for (int k = 0; k < 4; ++k) hidden[k] = hn::Mul(s, all(step.batch.occlusion[k][step.i]));
        if (hiding != Hiding::proportional) {  // else s and the occlusions are at most 1
            for (int k = 0; k < 3; ++k) hidden[k] = clamp_one(hidden[k]);
            if (hiding == Hiding::absorbing) absorb(step.batch, step.i, clamp_one(s), hidden);
            hidden[3] = hn::Div(hn::Add(hn::Add(hidden[0], hidden[1]), hidden[2]), all(3.0f));
        }
        fold_hidden<kMayClose>(step, s, weight, stop, hidden);
    }
    HWY_INLINE void close(V stop) {
        const M is_open = open(stop);
        alpha = hn::IfThenElse(is_open, alpha, hn::Sub(all(1.0f), held));
        for (int k = 0; k < 4; ++k) t[k] = hn::IfThenElseZero(is_open, t[k]);
    }

  private:
    /// `hidden`: what of the light behind it does not arrive, r, g, b and alpha.
    template <bool kMayClose>
    HWY_INLINE void fold_hidden(const FoldStep& step, V s, V weight, V stop, const V (&hidden)[4]) {
        const M is_open = kMayClose ? open(stop) : hn::Eq(s, s);
        const auto if_open = [&](V v) { return kMayClose ? hn::IfThenElseZero(is_open, v) : v; };
        for (int k = 0; k < 3; ++k) {
            const V reached = if_open(hn::Mul(t[k], s));
            const V light = hn::Mul(reached, all(step.batch.color[k][step.i]));
            color[k] = hn::Add(color[k], light);
            if (kAovs) accumulate(step.layer_light[k], light);
            t[k] = hn::Mul(t[k], hn::Sub(all(1.0f), hidden[k]));
        }
        const V share = if_open(hn::Mul(t[3], hidden[3]));
        const V shown = kHolds ? hn::Mul(share, all(step.batch.shows[step.i])) : share;
        if (kHolds) held = hn::Add(held, hn::Sub(share, shown));
        alpha = hn::Add(alpha, shown);
        t[3] = hn::Mul(t[3], hn::Sub(all(1.0f), hidden[3]));
        if (kAovs) accumulate(step.layer_light[3], shown);
        more.fold(step, s, weight, shown, is_open);
    }
};

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
