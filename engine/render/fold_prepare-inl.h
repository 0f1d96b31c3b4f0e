// Vector code that prepares a batch of splats for the fold: which cells and blocks they touch, on the frame
// or by directions for projections onto the sphere, their weights' cubics and normalisation, and their
// blending. Gives the footprints of footprint_at. Included once per instruction set.
#if defined(ASTROSPLAT_FOLD_PREPARE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_FOLD_PREPARE_INL_H
#undef ASTROSPLAT_FOLD_PREPARE_INL_H
#else
#define ASTROSPLAT_FOLD_PREPARE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/lanes-inl.h"
#include "render/fold_blend-inl.h"
#include "render/shape.h"
#include "render/shared_render.h"
#include "render/sphere_shape.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {

using Float = Lanes<D>;
using Int = LaneInts<D>;
using Bool = LaneBools<D>;
using Vec3 = LaneVectors<D>;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {
using namespace astrosplat::glsl;
using namespace astrosplat::shared_types;
#include "footprint.glsl"
}  // namespace
#pragma GCC diagnostic pop

/// Squared distance along one axis from `lanes` splats to the nearest pixel centre of a row or column
/// of blocks.
HWY_INLINE V distance_to_block(V center, float first_px) {
    const float half = 0.5f * float(TilePlanes::block_px - 1);
    const V middle = all(first_px + 0.5f * float(TilePlanes::block_px));
    const V distance = hn::Max(hn::Sub(hn::Abs(hn::Sub(center, middle)), all(half)), hn::Zero(D()));
    return hn::Mul(distance, distance);
}

/// Bits [first, first + lanes) of `words`, which are 0 there.
HWY_INLINE void set_bits(M mask, int first, std::uint64_t* words) {
    if constexpr (lanes % 8 == 0) {  // whole bytes, of little-endian words
        hn::StoreMaskBits(D(), mask, reinterpret_cast<std::uint8_t*>(words) + first / 8);
    } else {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(D(), mask, bytes);
        words[first / 64] |= std::uint64_t{bytes[0]} << first % 64;
    }
}
static_assert(std::endian::native == std::endian::little);

/// Which splats of the batch may have weight in which blocks of a cell whose corner is (x0, y0).
inline void find_touched_blocks(SplatBatch& batch, float x0_px, float y0_px) {
    constexpr int side = TilePlanes::cell_blocks;
    for (SplatBits& bits : batch.touches) bits = {};
    for (int n = 0; n < batch.count; n += lanes) {
        const V x = load(batch.x_px + n), y = load(batch.y_px + n), reach = load(batch.reach_px + n);
        const V reach_squared = hn::Mul(reach, reach);
        V dx[side];
        for (int c = 0; c < side; ++c) dx[c] = distance_to_block(x, x0_px + float(c * TilePlanes::block_px));
        for (int r = 0; r < side; ++r) {
            const V dy = distance_to_block(y, y0_px + float(r * TilePlanes::block_px));
            for (int c = 0; c < side; ++c)
                set_bits(hn::Le(hn::Add(dx[c], dy), reach_squared), n, &batch.touches[r * side + c].low);
        }
    }
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace sphere_maths {
namespace {
using namespace astrosplat::glsl;
using namespace astrosplat::shared_types;
using Float = Lanes<D>;
using Int = LaneInts<D>;
using Bool = LaneBools<D>;
using Vec3 = LaneVectors<D>;
#include "angles.glsl"
// before what needs it
#include "projections.inc"
}  // namespace
}  // namespace sphere_maths
#pragma GCC diagnostic pop

// ---- onto the sphere: the same by directions

/// A ball around the points of the sphere that some pixels show.
struct Cap {
    float x = 0.0f, y = 0.0f, z = 0.0f;
    float radius = -1.0f;  // < 0: they show nothing
};

/// That of the pixels [first, first + count) of the planes.
inline Cap cap_of(const TilePlanes& planes, std::size_t first, std::size_t count) {
    const auto at = [&](int k, std::size_t i) { return planes.toward[k][first + i]; };
    const auto shows = [&](std::size_t i) { return at(0, i) < 1e8f; };
    float sum[3] = {0.0f, 0.0f, 0.0f}, shown = 0.0f;
    for (std::size_t i = 0; i < count; ++i) {
        if (!shows(i)) continue;
        for (int k = 0; k < 3; ++k) sum[k] += at(k, i);
        shown += 1.0f;
    }
    if (shown == 0.0f) return {};
    Cap cap{sum[0] / shown, sum[1] / shown, sum[2] / shown, 0.0f};
    for (std::size_t i = 0; i < count; ++i) {
        if (!shows(i)) continue;
        const float x = at(0, i) - cap.x, y = at(1, i) - cap.y, z = at(2, i) - cap.z;
        cap.radius = std::max(cap.radius, std::sqrt(x * x + y * y + z * z));
    }
    cap.radius = cap.radius * 1.0001f + 0.001f;  // rounding must not lose a pixel
    return cap;
}

/// Sets the directions of all splats of a tile; `count` is filled up to whole vectors.
inline void find_directions(const Lens& lens, const Discs& discs, std::size_t count, Directions& toward) {
    toward.resize(count + lanes);
    const V focal = all(lens.focal_px);
    const float period = sphere_maths::period_px(lens);
    for (std::size_t i = 0; i < count; i += lanes) {
        Float x = hn::Load(D(), &discs.x_px[i]);
        const Float y = hn::Load(D(), &discs.y_px[i]);
        // The same bits at all of its places: whole periods are exact.
        if (period > 0.0f) x = x - period * floor((x - lens.center_x_px) / period + 0.5f);
        const Vec3 ray = sphere_maths::ray_through(lens, x, y);
        const V scale = hn::Div(focal, sqrt(dot(ray, ray)).v);
        hn::Store(hn::Mul(ray.x.v, scale), D(), &toward.x[i]);
        hn::Store(hn::Mul(ray.y.v, scale), D(), &toward.y[i]);
        hn::Store(hn::Mul(ray.z.v, scale), D(), &toward.z[i]);
    }
}

/// Which of `lanes` splats may reach into a cap.
HWY_INLINE M reaches(V x, V y, V z, V reach, const Cap& cap) {
    const V dx = hn::Sub(x, all(cap.x)), dy = hn::Sub(y, all(cap.y)), dz = hn::Sub(z, all(cap.z));
    const V squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const V within = hn::Add(reach, all(cap.radius));
    return hn::Le(squared, hn::Mul(within, within));
}

/// Appends those of the splats [begin, end) whose support may touch the cell and whose place on the frame is
/// the nearest of theirs to the middle of the cell's columns in use.
inline void find_on_sphere(const FoldScratch& scratch, std::size_t begin, std::size_t end, const Cap& cap,
                           float middle_px, float period_px, CellSplats& found) {
    if (cap.radius < 0.0f) return;
    const hn::RebindToUnsigned<D> du;
    const Discs& discs = scratch.discs;
    const V half = all(period_px > 0.0f ? 0.5f * period_px : 3e38f), middle = all(middle_px);
    for (std::size_t i = begin; i < end; i += lanes) {
        const V x = hn::Load(D(), &discs.x_px[i]), y = hn::Load(D(), &discs.y_px[i]),
                reach = hn::Load(D(), &discs.reach_px[i]);
        const V toward_x = hn::Load(D(), &scratch.toward.x[i]),
                toward_y = hn::Load(D(), &scratch.toward.y[i]),
                toward_z = hn::Load(D(), &scratch.toward.z[i]);
        const V to_middle = hn::Sub(middle, x);
        const M nearest = hn::And(hn::Ge(to_middle, hn::Neg(half)), hn::Lt(to_middle, half));
        const auto index = hn::Add(counting(du), hn::Set(du, std::uint32_t(i)));
        const M exists = hn::Lt(y, all(1e29f));  // not of the last vector's rest
        const M near = hn::And(hn::And(nearest, exists), reaches(toward_x, toward_y, toward_z, reach, cap));
        const std::size_t n = found.count;
        append(D(), x, near, &found.discs.x_px[n]);
        append(D(), y, near, &found.discs.y_px[n]);
        append(D(), reach, near, &found.discs.reach_px[n]);
        append(D(), toward_x, near, &found.toward.x[n]);
        append(D(), toward_y, near, &found.toward.y[n]);
        append(D(), toward_z, near, &found.toward.z[n]);
        append(du, index, hn::RebindMask(du, near), &found.index[n]);
        found.count = n + hn::CountTrue(D(), near);
    }
}

/// Which splats of the batch may have weight in which blocks of a cell.
inline void find_touched_caps(SplatBatch& batch, const Cap* caps) {
    for (SplatBits& bits : batch.touches) bits = {};
    for (int n = 0; n < batch.count; n += lanes) {
        const V x = load(batch.toward[0] + n), y = load(batch.toward[1] + n), z = load(batch.toward[2] + n),
                reach = load(batch.reach_px + n);
        const M exists = hn::Lt(load(batch.y_px + n), all(1e29f));
        for (int block = 0; block < SplatBatch::blocks; ++block) {
            if (caps[block].radius < 0.0f) continue;
            set_bits(hn::And(exists, reaches(x, y, z, reach, caps[block])), n, &batch.touches[block].low);
        }
    }
}

// ---- weights

/// Values between two nodes.
template <class Tag>
HWY_INLINE void interpolate(Tag d, const float* a, const float* b, float t, float* to) {
    const auto from = hn::Load(d, a);
    hn::Store(hn::Add(from, hn::Mul(hn::Sub(hn::Load(d, b), from), hn::Set(d, t))), d, to);
}

HWY_INLINE void interpolate_cubics(const FootprintNode& a, const FootprintNode& b, float t, SplatBatch& batch,
                                   int i) {
    for (int power = 0; power < 4; ++power)
        for (int s = 0; s < segments; s += lanes)
            interpolate(D(), a.cubic[power] + s, b.cubic[power] + s, t, batch.cubic[i][power] + s);
}

/// Between which nodes the radii of splats n to n + lanes lie.
HWY_INLINE void find_nodes(SplatBatch& batch, int n) {
    const NodePlace place = node_of_radius(load(batch.radius_px + n));
    hn::Store(place.first.v, DI(), batch.node + n);
    store(place.share.v, batch.node_share + n);
}

/// The part of a footprint that is looked up: cubics and moments between the table's nodes.
HWY_INLINE void look_up_footprint(const FootprintTable& table, SplatBatch& batch, int i) {
    const hn::CappedTag<float, 4> four;
    const FootprintNode* a = table.nodes.data() + batch.node[i];
    const FootprintNode* b = std::min(a + 1, &table.nodes.back());
    const float t = batch.node_share[i];
    interpolate_cubics(*a, *b, t, batch, i);
    const int quads = table.linear_in_distance ? 3 : table.flat_core ? 2 : 1;
    for (int k = 0; k < 4 * quads; k += int(hn::MaxLanes(four)))  // one without vectors
        interpolate(four, &a->moments.mean + k, &b->moments.mean + k, t, batch.moments[k / 4][i] + k % 4);
}

/// pixel_cosine of `lanes` coordinates.
HWY_INLINE V pixel_cosines_of(V coordinate_px) {
    const V inside = hn::Min(hn::Max(coordinate_px, all(-pixel_cosine_far_px)), all(pixel_cosine_far_px));
    const VI phase = hn::And(hn::ConvertTo(DI(), hn::Mul(inside, all(256.0f))), hn::Set(DI(), 255));
    return hn::GatherIndex(D(), pixel_cosines.data(), phase);
}

/// Four moments of `lanes` splats from splat n on.
struct Moments {
    V v[4];
    HWY_INLINE Moments(const SplatBatch& batch, int quad, int n) {
        hn::LoadInterleaved4(D(), batch.moments[quad][n], v[0], v[1], v[2], v[3]);
    }
};

/// Relative excess of the sum over all pixels over the integral; moments 1 to 3 are the spectrum.
HWY_INLINE Float ripple(const Moments& m, V cx, V cy) { return pixel_ripple(m.v[1], m.v[2], m.v[3], cx, cy); }

/// The part of the footprint that is computed, for splats n to n + lanes: footprint_at, many at once.
HWY_INLINE void normalise_footprints(const FootprintTable& table, SplatBatch& batch, int n) {
    const bool linear = table.linear_in_distance;
    const Float radius_px = load(batch.radius_px + n), tabulated_px = max(radius_px, SMALLEST_RADIUS_PX);
    const NodePlace node{hn::Load(DI(), batch.node + n), load(batch.node_share + n)};
    const ProfileRange range =
        profile_range(table.core, table.reach, 4.0f * table.pixel_filter_px, tabulated_px);
    Float first_moment = 0.0f, edge_first_moment = 0.0f;
    if (linear) {
        const Moments first(batch, 2, n);
        first_moment = first.v[0];
        edge_first_moment = first.v[1];
    }
    const Moments plain(batch, 0, n);
    const V cx = pixel_cosines_of(load(batch.x_px + n)), cy = pixel_cosines_of(load(batch.y_px + n));
    const Float found =
        profile_mass(linear, range, plain.v[0], first_moment) * (1.0f + ripple(plain, cx, cy));
    Float edge_found = 1.0f;
    if (table.flat_core) {
        const Moments edge(batch, 1, n);
        edge_found = edge_mass(linear, range, edge.v[0], edge_first_moment) * (1.0f + ripple(edge, cx, cy));
    }
    const FootprintGains gains =
        footprint_gains(table.flat_core, is_tabulated(node), shrink_of_radius(radius_px),
                        table.integral * tabulated_px * tabulated_px, found, edge_found);
    store(profile_begin(linear, range).v, batch.lo + n);
    store((float(segments) / profile_width(linear, range)).v, batch.scale + n);
    store(gains.edge_gain.v, batch.edge_gain + n);
    store(gains.amplitude.v, batch.weight_gain + n);
}

/// Weights of a splat whose layer is not the only one, or that is drawn with splats that are not round.
HWY_INLINE void prepare_weight(const FoldJob& job, const ScreenSplat& splat, SplatBatch& batch, int i) {
    const FootprintTable& table = *job.layers[splat.layer].footprints;
    const Lens& lens = job.settings.lens;
    const bool round = job.shapes.empty() || is_round(splat), sphere = shared::is_onto_sphere(lens);
    ShapedFootprint shaped;
    batch.shaped[i] = !round;
    if (sphere && round) {
        shaped.round = sphere_footprint_at(table, lens, splat.radius_px, splat.x_px, splat.y_px);
    } else if (sphere) {
        const SphereFootprint on_map =
            shaped_sphere_footprint_at(table, lens, job.shapes[shape_number(splat)], splat.x_px, splat.y_px);
        shaped.round = on_map.round;
        for (int r = 0; r < 2; ++r)
            for (int k = 0; k < 3; ++k) batch.row[r][k][i] = on_map.rows[r][k];
    } else if (round) {
        footprint_at(table, splat.radius_px, splat.x_px, splat.y_px, shaped.round);
    } else {
        shaped = shaped_footprint_at(table, job.shapes[shape_number(splat)], splat.x_px, splat.y_px);
    }
    const Footprint& f = shaped.round;
    batch.linear_in_distance[i] = table.linear_in_distance;
    interpolate_cubics(*f.node_a, *f.node_b, f.t, batch, i);
    batch.lo[i] = f.lo;
    batch.scale[i] = f.scale;
    batch.edge_gain[i] = f.edge_gain;
    batch.weight_gain[i] = f.amplitude;
    batch.map_xx[i] = shaped.xx;
    batch.map_xy[i] = shaped.xy;
    batch.map_yy[i] = shaped.yy;
}

/// Occlusion colours: what the general fold alone asks for.
HWY_INLINE void prepare_occlusion(const ScreenSplat& splat, const FoldLayer& layer, SplatBatch& batch,
                                  int i) {
    const float h = float(splat.hybrid) * (1.0f / 65535.0f);
    const int blend = layer.holdout ? shared::BLEND_OVER : int(layer.blend);
    batch.shows[i] = layer.holdout ? 0.0f : 1.0f;
    const bool absorbs = !layer.holdout && shared::blend_absorbs(blend, splat.color[0]);
    float sum = 0.0f;
    bool bright = false;
    for (int k = 0; k < 3; ++k) {
        if (layer.holdout || absorbs) batch.color[k][i] = 0.0f;
        batch.occlusion[k][i] = absorbs ? shared::blend_exponent(blend, splat.color[k], layer.absorb[k])
                                        : shared::blend_occlusion(blend, splat.color[k], h);
        sum += batch.occlusion[k][i];
        bright = bright || (blend == shared::BLEND_SCREEN && splat.color[k] > 1.0f);
    }
    batch.occlusion[3][i] = sum / 3.0f;
    const bool plain = blend == shared::BLEND_OVER && !absorbs;
    batch.hiding[i] = plain     ? Hiding::plain
                      : absorbs ? Hiding::absorbing
                      : bright  ? Hiding::clamped
                                : Hiding::proportional;
}

/// The same for `lanes` splats that are all screens.
HWY_INLINE void prepare_screens(SplatBatch& batch, int n) {
    V sum = hn::Zero(D());
    M bright = hn::Lt(sum, sum);
    for (int k = 0; k < 3; ++k) {
        const V color = load(batch.color[k] + n);
        store(color, batch.occlusion[k] + n);
        sum = hn::Add(sum, color);
        bright = hn::Or(bright, hn::Gt(color, all(1.0f)));
    }
    store(hn::Div(sum, all(3.0f)), batch.occlusion[3] + n);
    store(all(1.0f), batch.shows + n);
    std::fill_n(batch.hiding + n, lanes, Hiding::proportional);
    if (hn::AllFalse(D(), bright)) return;
    alignas(64) float is_bright[lanes];
    store(hn::IfThenElseZero(bright, all(1.0f)), is_bright);
    for (int i = 0; i < lanes; ++i)
        if (is_bright[i] > 0.0f) batch.hiding[n + i] = Hiding::clamped;
}

inline float depth_of(const ScreenSplat& splat, const FoldSettings& settings) {
    return shared::axis_depth(settings.lens, splat.x_px, splat.y_px, std::bit_cast<float>(splat.depth));
}

/// Everything about the splats `which` of the batch.
template <class Pixels>
void prepare_splats(const FoldJob& job, const FoldCommon& common, SplatBits which, SplatBatch& batch) {
    for (SplatBits rest = which; rest.any();) {
        const int i = rest.take_first();
        const ScreenSplat& splat = *job.splats[batch.index[i]];
        batch.radius_px[i] = splat.radius_px;
        batch.alpha[i] = splat.opacity;
        for (int k = 0; k < 3; ++k) batch.color[k][i] = splat.color[k];
        if (!common.footprints) prepare_weight(job, splat, batch, i);
        if constexpr (Pixels::general)
            if (!common.screen) prepare_occlusion(splat, job.layers[splat.layer], batch, i);
        if constexpr (Pixels::aovs) {
            batch.layer[i] = splat.layer;
            batch.depth[i] = depth_of(splat, job.settings);
        }
    }
    if (common.footprints) {
        for (int n = 0; n < batch.count; n += lanes) find_nodes(batch, n);
        while (which.any()) look_up_footprint(*common.footprints, batch, which.take_first());
    }
    constexpr float faint = 0.99f;  // leaves more room than the cubics go above 1
    M is_faint = hn::Eq(hn::Zero(D()), hn::Zero(D()));
    for (int n = 0; n < batch.count; n += lanes) {
        if (common.footprints) normalise_footprints(*common.footprints, batch, n);
        const V opacity = hn::Mul(load(batch.alpha + n), load(batch.weight_gain + n));
        store(opacity, batch.opacity + n);
        is_faint = hn::And(is_faint, hn::Lt(opacity, all(faint)));
        if (Pixels::general && common.screen) prepare_screens(batch, n);
    }
    batch.is_faint = hn::AllTrue(D(), is_faint);
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
