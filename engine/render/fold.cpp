#include "render/fold.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/shared_render.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/fold.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h has to come before highway.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
constexpr int segments = FootprintNode::segments;

/// Sixteen coefficients in registers, looked up by a vector of segment numbers.
struct Coefficients {
    V part[segments / lanes];
};

/// Coefficients of one power, interpolated between the footprint's two nodes.
HWY_INLINE Coefficients load_coefficients(const Footprint& f, int power) {
    const V t = hn::Set(D(), f.t);
    Coefficients c;
    for (int i = 0; i < segments / lanes; ++i) {
        const V a = hn::Load(D(), f.node_a->cubic[power] + i * lanes);
        const V b = hn::Load(D(), f.node_b->cubic[power] + i * lanes);
        c.part[i] = hn::Add(a, hn::Mul(hn::Sub(b, a), t));
    }
    return c;
}

/// Lookup by the lowest four bits of `segment`.
HWY_INLINE V look_up(const Coefficients& c, VI segment) {
    const auto index = hn::IndicesFromVec(D(), hn::And(segment, hn::Set(DI(), lanes - 1)));
    V r = hn::TableLookupLanes(c.part[0], index);
    if constexpr (lanes < segments) {
        const VI low = hn::And(segment, hn::Set(DI(), segments - 1));
        for (int i = 1; i < segments / lanes; ++i) {
            const auto here = hn::RebindMask(D(), hn::Gt(low, hn::Set(DI(), i * lanes - 1)));
            r = hn::IfThenElse(here, hn::TableLookupLanes(c.part[i], index), r);
        }
    }
    return r;
}

/// One splat's footprint as vectors: weight of pixels at squared distances.
template <bool kRoot, bool kFlat>
struct Weights {
    Coefficients c0, c1, c2, c3;
    V lo, scale, edge_gain;

    HWY_INLINE explicit Weights(const Footprint& f)
        : c0(load_coefficients(f, 0)),
          c1(load_coefficients(f, 1)),
          c2(load_coefficients(f, 2)),
          c3(load_coefficients(f, 3)),
          lo(hn::Set(D(), f.lo)),
          scale(hn::Set(D(), f.scale)),
          edge_gain(hn::Set(D(), f.edge_gain)) {}

    /// Not clamped: the cubics may leave [0, 1] by a few 1e-5.
    HWY_INLINE V operator()(V distance_squared) const {
        const D d;
        const V place = kRoot ? hn::Sqrt(distance_squared) : distance_squared;
        // Only flat cores have an inside (place < lo).
        const V u = kFlat ? hn::Max(hn::Mul(hn::Sub(place, lo), scale), hn::Zero(d)) : hn::Mul(place, scale);
        // Rounding to the nearest whole number in the lowest bits of a float is the segment; on a segment's
        // end either side will do. Far outside, both are nonsense that the mask takes away.
        const V magic = hn::Set(d, 12582912.0f);  // 1.5 * 2^23
        const V rounded = hn::Add(hn::Sub(u, hn::Set(d, 0.5f)), magic);
        const VI segment = hn::BitCast(DI(), rounded);
        const V f = hn::Sub(u, hn::Sub(rounded, magic));
        V p = hn::Add(hn::Mul(look_up(c3, segment), f), look_up(c2, segment));
        p = hn::Add(hn::Mul(p, f), look_up(c1, segment));
        p = hn::Add(hn::Mul(p, f), look_up(c0, segment));
        p = hn::IfThenElseZero(hn::Lt(u, hn::Set(d, static_cast<float>(segments))), p);
        if (kFlat) p = hn::Add(p, hn::Mul(edge_gain, hn::Mul(p, hn::Sub(hn::Set(d, 1.0f), p))));
        return p;
    }
};

/// One splat's constants for the fold.
struct SplatConstants {
    float opacity;      // times amplitude
    float weight_gain;  // amplitude alone, for coverage
    float color[3];
    float occlusion[4];  // o per channel; [3] for alpha
    bool bright_screen;  // a colour above 1 under screen: alpha is the mean of the clamped channels
    float shows;         // 0 for holdouts
    float depth;
    float* layer_light[4];
};

/// Where a tile's planes begin: a local copy of these stays in registers, the planes' own would be read again
/// after every store.
struct PlanePointers {
    float* color[3];
    float* alpha;
    float* transmittance[4];
    float* held;
    float* depth_sum;
    float* uncovered;
    float* count;
};

PlanePointers pointers_to(TilePlanes& t) {
    PlanePointers p{};
    for (int k = 0; k < 3; ++k) p.color[k] = t.color[k].data();
    for (int k = 0; k < 4; ++k) p.transmittance[k] = t.transmittance[k].data();
    p.alpha = t.alpha.data();
    p.held = t.held.data();
    p.depth_sum = t.depth_sum.data();
    p.uncovered = t.uncovered.data();
    p.count = t.count.data();
    return p;
}

HWY_INLINE V load(const float* p) { return hn::LoadU(D(), p); }
HWY_INLINE void store(V v, float* p) { hn::StoreU(v, D(), p); }
HWY_INLINE void accumulate(float* p, V v) { store(hn::Add(load(p), v), p); }
HWY_INLINE V clamp_one(V v) { return hn::Min(v, hn::Set(D(), 1.0f)); }
HWY_INLINE V saturate(V v) { return clamp_one(hn::Max(v, hn::Zero(D()))); }

/// Over: one transmittance.
HWY_INLINE void fold_over(const PlanePointers& t, std::size_t i, V s, const SplatConstants& c, V stop) {
    const D d;
    const V one = hn::Set(d, 1.0f);
    const V before = load(&t.transmittance[0][i]);
    const V share = hn::Mul(before, s);
    for (int k = 0; k < 3; ++k) accumulate(&t.color[k][i], hn::Mul(share, hn::Set(d, c.color[k])));
    const V after = hn::Mul(before, hn::Sub(one, s));
    const auto done = hn::Lt(after, stop);
    store(hn::IfThenElse(done, one, hn::Add(load(&t.alpha[i]), share)), &t.alpha[i]);
    store(hn::IfThenZeroElse(done, after), &t.transmittance[0][i]);
}

HWY_INLINE void fold_add(const PlanePointers& t, std::size_t i, V s, const SplatConstants& c) {
    for (int k = 0; k < 3; ++k) accumulate(&t.color[k][i], hn::Mul(s, hn::Set(D(), c.color[k])));
}

HWY_INLINE void add_aovs(const PlanePointers& t, std::size_t i, V s, V weight, V alpha_share, V open,
                         const SplatConstants& c) {
    const D d;
    const V one = hn::Set(d, 1.0f);
    accumulate(&t.depth_sum[i], hn::Mul(alpha_share, hn::Set(d, c.depth)));
    const auto touched = hn::And(hn::Gt(s, hn::Zero(d)), hn::Gt(open, hn::Zero(d)));
    accumulate(&t.count[i], hn::IfThenElseZero(touched, one));
    const V rest = hn::Mul(load(&t.uncovered[i]), hn::Sub(one, saturate(weight)));
    store(hn::IfThenElse(touched, rest, load(&t.uncovered[i])), &t.uncovered[i]);
}

template <bool kAovs>
HWY_INLINE void fold_lighten(const PlanePointers& t, std::size_t i, V s, V weight, const SplatConstants& c) {
    const D d;
    for (int k = 0; k < 3; ++k) {
        float* p = &t.color[k][i];
        store(hn::Max(load(p), hn::Mul(s, hn::Set(d, c.color[k]))), p);
    }
    const V before = load(&t.transmittance[3][i]);
    const V share = hn::Mul(before, s);
    accumulate(&t.alpha[i], share);
    store(hn::Mul(before, hn::Sub(hn::Set(d, 1.0f), s)), &t.transmittance[3][i]);
    if (kAovs) add_aovs(t, i, s, weight, share, hn::Set(d, 1.0f), c);
}

template <bool kAovs, bool kHolds>
HWY_INLINE void fold_general(const PlanePointers& t, std::size_t i, V s, V weight, const SplatConstants& c,
                             V stop) {
    const D d;
    const V one = hn::Set(d, 1.0f);
    V sum = hn::Zero(d), largest = hn::Zero(d), open = hn::Zero(d), after[4];
    for (int k = 0; k < 3; ++k) {
        const V before = load(&t.transmittance[k][i]);
        const V light = hn::Mul(hn::Mul(before, s), hn::Set(d, c.color[k]));
        accumulate(&t.color[k][i], light);
        if (kAovs && c.layer_light[k]) accumulate(c.layer_light[k] + i, light);
        const V hidden = clamp_one(hn::Mul(s, hn::Set(d, c.occlusion[k])));
        sum = hn::Add(sum, hidden);
        after[k] = hn::Mul(before, hn::Sub(one, hidden));
        largest = hn::Max(largest, after[k]);
        open = hn::Max(open, before);
    }
    V hidden = clamp_one(hn::Mul(s, hn::Set(d, c.occlusion[3])));
    if (c.bright_screen) hidden = hn::Div(sum, hn::Set(d, 3.0f));
    const V before = load(&t.transmittance[3][i]);
    const V share = hn::Mul(before, hidden);
    const V shown = kHolds ? hn::Mul(share, hn::Set(d, c.shows)) : share;
    V full = one;
    if (kHolds) {
        const V held = hn::Add(load(&t.held[i]), hn::Sub(share, shown));
        store(held, &t.held[i]);
        full = hn::Sub(one, held);
    }
    after[3] = hn::Mul(before, hn::Sub(one, hidden));
    largest = hn::Max(largest, after[3]);
    const auto done = hn::Lt(largest, stop);
    store(hn::IfThenElse(done, full, hn::Add(load(&t.alpha[i]), shown)), &t.alpha[i]);
    for (int k = 0; k < 4; ++k) store(hn::IfThenZeroElse(done, after[k]), &t.transmittance[k][i]);
    if (kAovs) {
        if (c.layer_light[3]) accumulate(c.layer_light[3] + i, shown);
        add_aovs(t, i, s, weight, shown, hn::Max(open, before), c);
    }
}

/// Rows and columns of the tile that a splat's support touches, px from the tile's corner, ends excluded.
struct PixelRange {
    int x0, x1, y0, y1;
};

template <FoldKind kKind, bool kAovs, bool kHolds, bool kRoot, bool kFlat>
void fold_splat(TilePlanes& t, const Footprint& footprint, float x_px, float y_px, const PixelRange& range,
                const std::vector<std::uint8_t>& row_open, const SplatConstants& c, float stop_at) {
    const D d;
    const PlanePointers planes = pointers_to(t);
    const Weights<kRoot, kFlat> weights(footprint);
    const V opacity = hn::Set(d, c.opacity), stop = hn::Set(d, stop_at);
    // Offsets of pixel centres from the splat's centre are exact: both are multiples of 1/256 px.
    const float left = static_cast<float>(t.x0) - x_px, top = static_cast<float>(t.y0) + 0.5f - y_px;
    // Wide footprints start at whole vectors, so that no load crosses a cache line.
    const int first = range.x1 - range.x0 > lanes ? range.x0 / lanes * lanes : range.x0;
    const int vectors = (range.x1 - first + lanes - 1) / lanes;
    V dx_squared[TilePlanes::widest_px / lanes];
    for (int n = 0; n < vectors; ++n) {
        const V dx = hn::Add(hn::Iota(d, 0.5f), hn::Set(d, left + static_cast<float>(first + n * lanes)));
        dx_squared[n] = hn::Mul(dx, dx);
    }
    const float reach_squared = footprint.support_px * footprint.support_px;
    for (int y = range.y0; y < range.y1; ++y) {
        if (!row_open[static_cast<std::size_t>(y)]) continue;
        const float dy = top + static_cast<float>(y);
        const V dy_squared = hn::Set(d, dy * dy);
        int n0 = 0, n1 = vectors;
        if (vectors > 2) {  // skip the corners of the support's square; weights there are 0
            const float half = std::sqrt(std::max(0.0f, reach_squared - dy * dy)) + 1.0f;
            const float middle = -left - static_cast<float>(first),
                        per_lane = 1.0f / static_cast<float>(lanes);
            n0 = static_cast<int>(std::max(0.0f, (middle - half) * per_lane));
            n1 = static_cast<int>(std::min(static_cast<float>(vectors), (middle + half) * per_lane + 1.0f));
        }
        for (int n = n0; n < n1; ++n) {
            const V w = weights(hn::Add(dx_squared[n], dy_squared));
            const V s = saturate(hn::Mul(opacity, w));
            const std::size_t i = t.at(first + n * lanes, y);
            if constexpr (kKind == FoldKind::over) fold_over(planes, i, s, c, stop);
            if constexpr (kKind == FoldKind::add) fold_add(planes, i, s, c);
            const V weight = hn::Mul(w, hn::Set(d, c.weight_gain));
            if constexpr (kKind == FoldKind::lighten) fold_lighten<kAovs>(planes, i, s, weight, c);
            if constexpr (kKind == FoldKind::general)
                fold_general<kAovs, kHolds>(planes, i, s, weight, c, stop);
        }
    }
}

PixelRange pixels_of(const TilePlanes& t, const ScreenSplat& splat, float support_px) {
    const auto clamped = [](float px, int limit) {
        return static_cast<int>(std::clamp(px, 0.0f, static_cast<float>(limit)));
    };
    const float x = splat.x_px - static_cast<float>(t.x0), y = splat.y_px - static_cast<float>(t.y0);
    return {clamped(std::ceil(x - support_px - 0.5f), t.width),
            clamped(std::floor(x + support_px - 0.5f) + 1.0f, t.width),
            clamped(std::ceil(y - support_px - 0.5f), t.height),
            clamped(std::floor(y + support_px - 0.5f) + 1.0f, t.height)};
}

SplatConstants constants_of(const ScreenSplat& splat, const FoldLayer& layer, const Footprint& footprint,
                            const FoldSettings& settings, TilePlanes& planes) {
    SplatConstants c{};
    const float h = static_cast<float>(splat.hybrid) * (1.0f / 65535.0f);
    const int blend = layer.holdout ? shared::BLEND_OVER : static_cast<int>(layer.blend);
    c.opacity = splat.opacity * footprint.amplitude;
    c.weight_gain = footprint.amplitude;
    c.shows = layer.holdout ? 0.0f : 1.0f;
    float sum = 0.0f;
    for (int k = 0; k < 3; ++k) {
        c.color[k] = layer.holdout ? 0.0f : splat.color[k];
        c.occlusion[k] = shared::blend_occlusion(blend, splat.color[k], h);
        sum += c.occlusion[k];
        c.bright_screen = c.bright_screen || (blend == shared::BLEND_SCREEN && splat.color[k] > 1.0f);
    }
    c.occlusion[3] = sum / 3.0f;
    if (settings.aovs) {
        const float x = (splat.x_px - settings.center_x_px) / settings.focal_px;
        const float y = (splat.y_px - settings.center_y_px) / settings.focal_px;
        const float key = std::bit_cast<float>(splat.depth);
        c.depth = settings.orthographic ? key : std::sqrt(key / (1.0f + x * x + y * y));
    }
    if (settings.aovs)
        for (std::size_t k = 0; k < 4; ++k) c.layer_light[k] = planes.layer_light[4 * splat.layer + k].data();
    return c;
}

/// Marks the rows that still take light; false when none does.
bool find_open_rows(const TilePlanes& t, FoldKind kind, std::vector<std::uint8_t>& row_open) {
    if (kind == FoldKind::add || kind == FoldKind::lighten) return true;
    bool any = false;
    const int planes = kind == FoldKind::over ? 1 : 4;
    for (int y = 0; y < t.height; ++y) {
        if (!row_open[static_cast<std::size_t>(y)]) continue;
        bool open = false;
        for (int k = 0; k < planes && !open; ++k) {
            const float* row = &t.transmittance[k][t.at(0, y)];
            for (int x = 0; x < t.width && !open; ++x) open = row[x] > 0.0f;
        }
        row_open[static_cast<std::size_t>(y)] = open;
        any = any || open;
    }
    return any;
}

template <FoldKind kKind, bool kAovs, bool kHolds>
void fold_all(std::span<const ScreenSplat> splats, std::span<const FoldLayer> layers,
              const FoldSettings& settings, const Progress& progress, TilePlanes& planes) {
    constexpr std::size_t look_every = 64, check_every = 1024;
    std::vector<std::uint8_t> row_open(static_cast<std::size_t>(planes.height), 1);
    Footprint footprint;
    for (std::size_t n = 0; n < splats.size(); ++n) {
        if (n % look_every == look_every - 1 && !find_open_rows(planes, kKind, row_open)) return;
        if (n % check_every == 0) progress.check();
        const ScreenSplat& splat = splats[n];
        const FoldLayer& layer = layers[splat.layer];
        const FootprintTable& table = *layer.footprints;
        const PixelRange range = pixels_of(planes, splat, table.support_px(splat.radius_px));
        if (range.x0 >= range.x1 || range.y0 >= range.y1) continue;
        footprint_at(table, splat.radius_px, splat.x_px, splat.y_px, footprint);
        const SplatConstants c = constants_of(splat, layer, footprint, settings, planes);
        const auto call = [&](auto* fold_one) {
            fold_one(planes, footprint, splat.x_px, splat.y_px, range, row_open, c, settings.stop);
        };
        if (table.linear_in_distance)
            table.flat_core ? call(&fold_splat<kKind, kAovs, kHolds, true, true>)
                            : call(&fold_splat<kKind, kAovs, kHolds, true, false>);
        else
            table.flat_core ? call(&fold_splat<kKind, kAovs, kHolds, false, true>)
                            : call(&fold_splat<kKind, kAovs, kHolds, false, false>);
    }
}

template <bool kAovs>
void fold_kind(std::span<const ScreenSplat> splats, std::span<const FoldLayer> layers,
               const FoldSettings& settings, const Progress& progress, TilePlanes& planes) {
    const bool holds =
        std::any_of(layers.begin(), layers.end(), [](const FoldLayer& layer) { return layer.holdout; });
    if (settings.kind == FoldKind::lighten)
        fold_all<FoldKind::lighten, kAovs, false>(splats, layers, settings, progress, planes);
    else if (holds)
        fold_all<FoldKind::general, kAovs, true>(splats, layers, settings, progress, planes);
    else
        fold_all<FoldKind::general, kAovs, false>(splats, layers, settings, progress, planes);
}

void fold_here(std::span<const ScreenSplat> splats, std::span<const FoldLayer> layers,
               const FoldSettings& settings, const Progress& progress, TilePlanes& planes) {
    if (settings.kind == FoldKind::over)
        fold_all<FoldKind::over, false, false>(splats, layers, settings, progress, planes);
    else if (settings.kind == FoldKind::add)
        fold_all<FoldKind::add, false, false>(splats, layers, settings, progress, planes);
    else if (settings.aovs)
        fold_kind<true>(splats, layers, settings, progress, planes);
    else
        fold_kind<false>(splats, layers, settings, progress, planes);
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(fold_here);

void fold(std::span<const ScreenSplat> splats, std::span<const FoldLayer> layers,
          const FoldSettings& settings, const Progress& progress, TilePlanes& planes) {
    HWY_DYNAMIC_DISPATCH(fold_here)(splats, layers, settings, progress, planes);
}

void TilePlanes::reset(const Region& tile, int tile_px, const FoldSettings& settings,
                       std::size_t layer_count) {
    x0 = tile.x;
    y0 = tile.y;
    width = static_cast<int>(tile.width);
    height = static_cast<int>(tile.height);
    stride = tile_px + widest_vector;
    const std::size_t size = static_cast<std::size_t>(stride) * static_cast<std::size_t>(tile_px);
    for (Buffer<float>& plane : color) plane.assign(size, 0.0f);
    alpha.assign(size, 0.0f);
    for (Buffer<float>& plane : transmittance) plane.assign(size, 1.0f);
    held.assign(size, 0.0f);
    if (settings.aovs) {
        depth_sum.assign(size, 0.0f);
        uncovered.assign(size, 1.0f);
        count.assign(size, 0.0f);
    }
    if (settings.aovs) {
        layer_light.resize(4 * layer_count);
        for (Buffer<float>& plane : layer_light) plane.assign(size, 0.0f);
    }
}

void SplatSorter::sort(std::vector<ScreenSplat>& splats, const Progress& progress) {
    const std::size_t n = splats.size();
    keys_.resize(n);
    other_.resize(n);
    std::uint32_t all_or = 0, all_and = 0xffffffffu;
    for (std::size_t i = 0; i < n; ++i) {
        keys_[i] = std::uint64_t{splats[i].depth} << 32 | i;
        all_or |= splats[i].depth;
        all_and &= splats[i].depth;
    }
    constexpr std::size_t check_every = 65536;
    constexpr int digit_bits = 11;
    constexpr std::uint32_t digits = 1u << digit_bits;
    for (int shift = 0; shift < 32; shift += digit_bits) {
        const std::uint32_t mask = digits - 1u;
        if (((all_or ^ all_and) >> shift & mask) == 0) continue;  // the same for all
        std::uint32_t start[digits + 1] = {};
        for (std::size_t i = 0; i < n; ++i) ++start[(keys_[i] >> (32 + shift) & mask) + 1];
        for (std::uint32_t d = 0; d < digits; ++d) start[d + 1] += start[d];
        for (std::size_t i = 0; i < n; ++i) {
            if (i % check_every == 0) progress.check();
            other_[start[keys_[i] >> (32 + shift) & mask]++] = keys_[i];
        }
        keys_.swap(other_);
    }
    sorted_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        if (i % check_every == 0) progress.check();
        sorted_[i] = splats[keys_[i] & 0xffffffffu];
    }
    for (std::size_t i = 0; i < n;) {
        std::size_t end = i + 1;
        while (end < n && sorted_[end].depth == sorted_[i].depth) ++end;
        if (end - i > 1) std::sort(sorted_.begin() + i, sorted_.begin() + end, in_front_of);
        i = end;
    }
    splats.swap(sorted_);
}

}  // namespace astrosplat
#endif  // HWY_ONCE
