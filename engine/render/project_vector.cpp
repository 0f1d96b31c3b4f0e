#include "render/project_vector.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/project_vector.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h has to come before highway.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::CappedTag<double, 8>;  // places are double until they are relative to the camera
using D = hn::Rebind<float, DD>;
using V = hn::Vec<D>;
using VD = hn::Vec<DD>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));

/// `lanes` splats on the picture.
struct Projected {
    alignas(64) float x[lanes], y[lanes], z[lanes];  // camera space
    alignas(64) float disc[lanes][4];                // x_px, y_px, radius_px, opacity
    alignas(64) float depth[lanes];
};

HWY_INLINE V all(float v) { return hn::Set(D(), v); }

/// Row `k` of camera_from_layer times the place, plus the origin; rounded to float last.
HWY_INLINE V camera_coordinate(const LayerProjection& layer, int k, VD x, VD y, VD z) {
    const DD d;
    const glm::dmat3& m = layer.camera_from_layer;
    VD sum = hn::Add(hn::Mul(hn::Set(d, m[0][k]), x), hn::Mul(hn::Set(d, m[1][k]), y));
    sum = hn::Add(hn::Add(sum, hn::Mul(hn::Set(d, m[2][k]), z)), hn::Set(d, layer.origin_in_camera[k]));
    return hn::DemoteTo(D(), sum);
}

HWY_INLINE V snap(V px) {
    return hn::Mul(hn::Floor(hn::Add(hn::Mul(px, all(256.0f)), all(0.5f))), all(1.0f / 256.0f));
}

/// Projects `lanes` splats from `begin` on; bit i of the result: splat begin + i shows.
HWY_INLINE std::uint32_t project_block(const LayerProjection& layer, std::int64_t begin,
                                       const ScreenRect& rect, Projected& c) {
    const DD dd;
    const ShadedSplats& splats = *layer.splats;
    const auto first = static_cast<std::size_t>(begin);
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    V layer_x, layer_y, layer_z;
    hn::LoadInterleaved3(D(), &splats.position[first].x, layer_x, layer_y, layer_z);
    const VD lx = hn::PromoteTo(dd, layer_x), ly = hn::PromoteTo(dd, layer_y),
             lz = hn::PromoteTo(dd, layer_z);
    const V x = camera_coordinate(layer, 0, lx, ly, lz), y = camera_coordinate(layer, 1, lx, ly, lz),
            pz = camera_coordinate(layer, 2, lx, ly, lz), z = hn::Neg(pz);
    const V alpha = hn::LoadU(D(), &splats.alpha[first]);
    const V radius = hn::Mul(hn::LoadU(D(), &splats.radius[first]), all(layer.radius_scale));
    const V px_per_unit = layer.orthographic ? all(layer.focal_px) : hn::Div(all(layer.focal_px), z);
    const V radius_px = hn::Mul(radius, px_per_unit);
    const V x_px = snap(hn::Add(all(layer.center_x_px), hn::Mul(x, px_per_unit)));
    const V y_px = snap(hn::Sub(all(layer.center_y_px), hn::Mul(y, px_per_unit)));
    const V support = hn::Add(hn::Mul(radius_px, all(layer.reach)), all(layer.margin_px));
    auto shows = hn::And(hn::Gt(z, all(layer.near)), hn::Gt(alpha, hn::Zero(D())));
    if (layer.far > 0.0f) shows = hn::And(shows, hn::Le(z, all(layer.far)));
    shows = hn::And(shows, hn::And(hn::Gt(hn::Add(x_px, support), all(rect.x0)),
                                   hn::Lt(hn::Sub(x_px, support), all(rect.x1))));
    shows = hn::And(shows, hn::And(hn::Gt(hn::Add(y_px, support), all(rect.y0)),
                                   hn::Lt(hn::Sub(y_px, support), all(rect.y1))));
    const V t =
        hn::Min(all(1.0f), hn::Div(hn::Sub(z, all(layer.near)), hn::Max(all(layer.near_fade), radius)));
    const V fade = hn::Mul(hn::Mul(t, t), hn::Sub(all(3.0f), hn::Mul(all(2.0f), t)));
    const V opacity = hn::Mul(hn::Mul(alpha, all(layer.opacity)), fade);
    shows = hn::And(shows, hn::Gt(opacity, hn::Zero(D())));
    const V squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(pz, pz));
    hn::Store(x, D(), c.x);
    hn::Store(y, D(), c.y);
    hn::Store(pz, D(), c.z);
    hn::StoreInterleaved4(x_px, y_px, radius_px, opacity, D(), c.disc[0]);
    hn::Store(layer.orthographic ? z : squared, D(), c.depth);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), shows, bits);
    return bits[0];
}

void project_blocks(const LayerProjection& layer, std::int64_t begin, std::int64_t end,
                    const ScreenRect& rect, Buffer<ScreenSplat>& out) {
    const bool hybrid = layer.render.blend == Blend::hybrid;
    const std::size_t before = out.size();
    out.resize(before + static_cast<std::size_t>(end - begin));
    ScreenSplat* to = out.data() + before;
    Projected c;
    for (; begin < end; begin += lanes) {
        for (std::uint32_t bits = project_block(layer, begin, rect, c); bits != 0; bits &= bits - 1) {
            const int i = std::countr_zero(bits);
            const std::int64_t index = begin + i;
            const glm::vec3& color = layer.splats->color[static_cast<std::size_t>(index)];
            *to++ = {c.disc[i][0],
                     c.disc[i][1],
                     c.disc[i][2],
                     c.disc[i][3],
                     {color.x, color.y, color.z},
                     std::bit_cast<std::uint32_t>(c.depth[i]),
                     static_cast<std::uint32_t>(index),
                     layer.layer,
                     hybrid ? hybrid_of(layer, {c.x[i], c.y[i], c.z[i]}) : std::uint16_t{0}};
        }
    }
    out.resize(static_cast<std::size_t>(to - out.data()));
}

int block_size() { return lanes; }

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(project_blocks);
HWY_EXPORT(block_size);

std::int64_t project_whole_blocks(const LayerProjection& layer, std::int64_t begin, std::int64_t end,
                                  const ScreenRect& rect, Buffer<ScreenSplat>& out) {
    const std::int64_t size = HWY_DYNAMIC_DISPATCH(block_size)();
    const std::int64_t whole = begin + (end - begin) / size * size;
    HWY_DYNAMIC_DISPATCH(project_blocks)(layer, begin, whole, rect, out);
    return whole;
}

}  // namespace astrosplat
#endif  // HWY_ONCE
