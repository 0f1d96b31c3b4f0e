#include "render/project.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/project_vector.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h has to come before highway.h.
#include <hwy/highway.h>

#include "core/lanes-inl.h"
#include "splats/splat_set.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::CappedTag<double, 8>;  // places are double until they are relative to the camera
using D = hn::Rebind<float, DD>;
using VD = hn::Vec<DD>;
constexpr int lanes = int(hn::MaxLanes(D()));
using Float = Lanes<D>;
using Bool = LaneBools<D>;
using Vec3 = LaneVectors<D>;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {
using namespace astrosplat::glsl;
using namespace astrosplat::shared_types;
#include "angles.glsl"
// before what needs it
#include "projections.inc"
}  // namespace
#pragma GCC diagnostic pop

/// `lanes` splats on the frame.
struct Projected {
    alignas(64) float x[lanes], y[lanes], z[lanes];  // camera space
    alignas(64) float disc[lanes][4];                // x_px, y_px, radius_px, opacity
    alignas(64) float sort_depth[lanes];
    alignas(64) float support_px[lanes];  // on the frame
};

/// Row `k` of camera_from_layer times the place, plus the origin; rounded to float last.
HWY_INLINE Float camera_coordinate(const LayerProjection& layer, int k, VD x, VD y, VD z) {
    const DD d;
    const glm::dmat3& m = layer.camera_from_layer;
    VD sum = hn::Add(hn::Mul(hn::Set(d, m[0][k]), x), hn::Mul(hn::Set(d, m[1][k]), y));
    sum = hn::Add(hn::Add(sum, hn::Mul(hn::Set(d, m[2][k]), z)), hn::Set(d, layer.origin_in_camera[k]));
    return Float(hn::DemoteTo(D(), sum));
}

HWY_INLINE std::uint32_t bits_of(hn::Mask<D> mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    return bits[0];
}

/// Which of the splats from `first` on are stars.
HWY_INLINE std::uint32_t star_bits(const ShadedSplats& splats, std::size_t first) {
    std::uint32_t bits = 0;
    for (int i = 0; i < lanes; ++i) bits |= std::uint32_t{is_star(splats.id[first + i])} << i;
    return bits;
}

/// Which splats look so large that level of detail divides them.
HWY_INLINE Bool is_large(const LayerProjection& layer, Vec3 p, Float radius) {
    const Float px_per_unit = instance_of(layer.lens, beyond_near(layer.lens, p)).px_per_unit;
    return 2.0f * radius * px_per_unit > Float(layer.lod_limit_px);
}

/// Of those: neither they nor their children may show.
HWY_INLINE Bool is_out_of_sight(const LayerProjection& layer, Vec3 p, const Instance& at, Float radius,
                                const ScreenRect& rect) {
    const Float reach = radius * child_reach, near = layer.lens.near;
    const Float px = reach_px(layer.lens, p, reach, Float(layer.margin_px));
    const Bool behind = at.depth + reach<near, in_front = at.depth - reach> near;
    return behind || (in_front &&
                      !appears_in_rect(layer.lens, at.x_px, at.y_px, px, rect.x0, rect.y0, rect.x1, rect.y1));
}

/// Splats of a block by their bits.
struct Found {
    std::uint32_t shows;
    std::uint32_t rest;  // not projected
};

/// Projects `lanes` splats from `begin` on.
HWY_INLINE Found project_block(const LayerProjection& layer, std::int64_t begin, const ScreenRect& rect,
                               Projected& c) {
    const DD dd;
    const ShadedSplats& splats = *layer.splats;
    const auto first = std::size_t(begin);
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    hn::Vec<D> layer_x, layer_y, layer_z;
    hn::LoadInterleaved3(D(), &splats.position[first].x, layer_x, layer_y, layer_z);
    const VD lx = hn::PromoteTo(dd, layer_x), ly = hn::PromoteTo(dd, layer_y),
             lz = hn::PromoteTo(dd, layer_z);
    const Vec3 p{camera_coordinate(layer, 0, lx, ly, lz), camera_coordinate(layer, 1, lx, ly, lz),
                 camera_coordinate(layer, 2, lx, ly, lz)};
    const Float alpha = hn::LoadU(D(), &splats.alpha[first]);
    const Float radius = Float(hn::LoadU(D(), &splats.radius[first])) * layer.radius_scale;
    const Instance at = instance_of(layer.lens, p);
    const Float radius_px = radius * at.px_per_unit;
    const Float x_px = snap_px(at.x_px), y_px = snap_px(at.y_px);
    const Float support_px =
        frame_reach_px(layer.lens, x_px, y_px, radius_px * layer.reach + layer.margin_px);
    const Float opacity = alpha * layer.opacity * near_fade(layer.lens, at.depth, radius);
    const Bool shows =
        is_in_range(layer.lens, at.depth) && alpha > 0.0f && opacity > 0.0f &&
        appears_in_rect(layer.lens, x_px, y_px, support_px, rect.x0, rect.y0, rect.x1, rect.y1);
    hn::Store(p.x.v, D(), c.x);
    hn::Store(p.y.v, D(), c.y);
    hn::Store(p.z.v, D(), c.z);
    hn::StoreInterleaved4(x_px.v, y_px.v, radius_px.v, opacity.v, D(), c.disc[0]);
    hn::Store(sort_depth(layer.lens, p).v, D(), c.sort_depth);
    hn::Store(support_px.v, D(), c.support_px);
    Found found{bits_of(shows.m), 0};
    const std::uint32_t large = layer.lod ? bits_of(is_large(layer, p, radius).m) : 0;
    if (large != 0) found.rest = large & ~bits_of(is_out_of_sight(layer, p, at, radius, rect).m);
    if (layer.star_distance > 0.0f) found.rest |= star_bits(splats, first);
    found.shows &= ~(found.rest | large);
    return found;
}

void project_blocks(const LayerProjection& layer, std::int64_t begin, std::int64_t end,
                    const ScreenRect& rect, Buffer<ScreenSplat>& out, Buffer<std::int64_t>& rest) {
    const bool hybrid = layer.render.blend == Blend::hybrid;
    const float period = period_px(layer.lens);
    const std::size_t before = out.size();
    if (period == 0.0f) out.resize(before + std::size_t(end - begin));
    ScreenSplat* to = out.data() + before;
    Projected c;
    for (; begin < end; begin += lanes) {
        const Found found = project_block(layer, begin, rect, c);
        for (std::uint32_t bits = found.rest; bits != 0; bits &= bits - 1)
            rest.push_back(begin + std::countr_zero(bits));
        for (std::uint32_t bits = found.shows; bits != 0; bits &= bits - 1) {
            const int i = std::countr_zero(bits);
            const std::int64_t index = begin + i;
            const glm::vec3& color = layer.splats->color[index];
            const ScreenSplat splat{c.disc[i][0],
                                    c.disc[i][1],
                                    c.disc[i][2],
                                    c.disc[i][3],
                                    {color.x, color.y, color.z},
                                    std::bit_cast<std::uint32_t>(c.sort_depth[i]),
                                    std::uint32_t(index),
                                    layer.layer,
                                    hybrid ? hybrid_of(layer, {c.x[i], c.y[i], c.z[i]}) : std::uint16_t{0}};
            if (period == 0.0f)
                *to++ = splat;
            else
                push_places(splat, period, c.support_px[i], rect, out);
        }
    }
    if (period == 0.0f) out.resize(to - out.data());
}

int block_size() { return lanes; }

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(project_blocks);
HWY_EXPORT(block_size);

std::int64_t project_whole_blocks(const LayerProjection& layer, std::int64_t begin, std::int64_t end,
                                  const ScreenRect& rect, Buffer<ScreenSplat>& out,
                                  Buffer<std::int64_t>& rest) {
    const std::int64_t size = HWY_DYNAMIC_DISPATCH(block_size)();
    const std::int64_t whole = begin + (end - begin) / size * size;
    HWY_DYNAMIC_DISPATCH(project_blocks)(layer, begin, whole, rect, out, rest);
    return whole;
}

}  // namespace astrosplat
#endif  // HWY_ONCE
