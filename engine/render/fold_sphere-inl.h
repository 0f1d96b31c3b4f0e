// Vector code of the fold for projections onto the sphere: which splats may touch a cell and its blocks, by
// directions. Included once per instruction set.
#if defined(ASTROSPLAT_FOLD_SPHERE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_FOLD_SPHERE_INL_H
#undef ASTROSPLAT_FOLD_SPHERE_INL_H
#else
#define ASTROSPLAT_FOLD_SPHERE_INL_H
#endif

#include <algorithm>
#include <cmath>

#include "core/lanes-inl.h"
#include "render/fold_blend-inl.h"
#include "render/fold_prepare-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {

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
/// the nearest of theirs to the cell's middle.
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
        const auto index = hn::Add(counting(du), hn::Set(du, static_cast<std::uint32_t>(i)));
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

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
