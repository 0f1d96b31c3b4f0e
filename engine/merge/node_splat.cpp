#include "merge/cut.h"

#include <glm/geometric.hpp>

#include "core/shared_maths.h"
#include "render/footprint.h"
#include "render/lod.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

/// A row of splats with the moments of what they stand for has dips between them; wider ones have few.
/// Cells of what is spread evenly are all alike and in line, so that what dips are left add up to stripes:
/// for a bell of variance s^2 every a they are 2 e^(-2 pi^2 s^2 / a^2) deep, 28 % for 1.2 times the a^2 / 12
/// of a cell, 17 % for 1.5. A cell that is longer than wide gets less of that: what is thin hides more than
/// what is wide.
constexpr double least_overlap = 1.2;

/// n splats, each of which would cover so much of the merged one's disc, as its alpha.
double alpha_together(const DepthTable& depths, double n, double cover) {
    return depths.alpha(n * depths.depth(std::min(1.0, cover)));
}

/// The level down to which noise shows in the mean over a place so wide: of cells that are narrower than its
/// spread the mean is 1, and a few samples would only miss that.
int level_seen(const CloudPlace& place) {
    const float spread = std::sqrt(glm::dot(place.spread, place.spread) / 3.0f);
    const float octaves_per_unit = 1.44269504f;  // 1 / ln 2
    const float octaves =
        octaves_per_unit * shared::as_log(place.radius / std::max(spread, 0.01f * place.radius));
    return std::max(0, int(std::floor(octaves)) + 3);
}

}  // namespace

MergeSettings::MergeSettings(const LayerRender& r, bool is_even)
    : render(r),
      even(is_even),
      depths(r.falloff),
      variance(falloff_variance(r.falloff)),
      overlap(is_even ? 1.5 : least_overlap) {}

NodeSplat splat_of(const MergeSettings& settings, const NodeSums& sums, const Across& across, float hybrid) {
    const LayerRender& render = settings.render;
    const double spread = std::max(0.0f, across.mean), largest = across.largest;
    const double evenness = largest > 0.0 ? std::max(0.0, 2.0 * spread / largest - 1.0) : 0.0;
    const double overlap = least_overlap + (settings.overlap - least_overlap) * evenness;
    const double square = double(sums.own) + overlap * spread / settings.variance;
    const double cover = double(sums.cover) * double(render.opacity) / square;  // of the disc
    const double n = double(sums.cover) * double(sums.cover) / double(sums.squares);
    NodeSplat splat;
    splat.radius = float(std::sqrt(square));
    splat.color = sums.light / sums.cover;
    const bool absorbs = shared::blend_absorbs(int(render.blend), splat.color.x);
    const Blend blend = render.holdout || absorbs ? Blend::over : render.blend;
    if (blend == Blend::add) {
        splat.alpha = float(std::min(1.0, cover));
        splat.color *= float(std::max(1.0, cover));
        return splat;
    }
    if (blend != Blend::screen && blend != Blend::hybrid) {
        splat.alpha = float(alpha_together(settings.depths, n, cover / n));
        return splat;
    }
    // Each channel is hidden by itself; what alpha cannot say the colour does, as for level of detail.
    constexpr double least = 1e-3;  // occlusion below which light is proportional to cover
    const auto hides = [&](int k) {
        const float o = shared::blend_occlusion(int(blend), splat.color[k], hybrid);
        return std::clamp(double(o), least, 1.0);
    };
    const double o[] = {hides(0), hides(1), hides(2)}, mean = (o[0] + o[1] + o[2]) / 3.0;
    const double alpha = std::min(1.0, alpha_together(settings.depths, n, cover / n * mean) / mean);
    for (int k = 0; k < 3; ++k)
        splat.color[k] *= float(alpha_together(settings.depths, n, cover / n * o[k]) / o[k] / alpha);
    splat.alpha = float(alpha);
    return splat;
}

/// The mean at the corners of a box, which has the second moments of the place; as the final frame fades from
/// one level to the next, so does this.
float cloud_light(const LayerProjection& layer, const CloudPlace& place) {
    const LevelOfDetail& lod = layer.render.lod;
    if (!(lod.noise > 0.0f)) return 1.0f;
    const glm::vec3 p = shared::beyond_near(layer.lens, place.in_camera);
    const float diameter_px =
        2.0f * place.radius * layer.radius_scale * shared::instance_of(layer.lens, p).px_per_unit;
    const LevelChoice choice = choose_levels(diameter_px, layer.lod_limit_px, lod.max_children);
    if (choice.fine == 0) return 1.0f;
    const float strength = structure_of(layer, place.in_camera, place.color, place.alpha);
    const ChildNoise noise =
        make_child_noise(strength, place.radius, std::min(choice.fine, level_seen(place)), layer.seed);
    constexpr int corners = 8;
    float light = 0.0f;
    for (int k = 0; k < corners; ++k) {
        const glm::vec3 corner(k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f, k & 4 ? 1.0f : -1.0f);
        light += child_light(noise, place.centre + corner * place.spread) / corners;
    }
    return choice.coarse > 0 ? light : 1.0f + choice.fade * (light - 1.0f);
}

}  // namespace astrosplat
