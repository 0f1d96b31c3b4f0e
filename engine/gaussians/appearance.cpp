#include "gaussians/appearance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/color.h"
#include "core/real.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

/// A Gaussian is its own nearest one.
GaussianProfile profile_of(const RenderLayer& layer) {
    const Falloff& falloff = layer.render.falloff;
    if (layer.gaussians && falloff.shape == Falloff::Shape::gaussian)
        return {1.0, std::sqrt(0.5 / double(falloff.sharpness))};
    return nearest_gaussian(falloff);
}

}  // namespace

LayerAppearance::LayerAppearance(const RenderLayer& layer, const Camera& camera, double gain)
    : layer_(layer),
      camera_(camera),
      gain_(static_cast<float>(gain)),
      profile_(profile_of(layer)),
      axis_(glm::normalize(layer.world_from_layer * layer.axis)) {
    assert(layer.splats && !layer.stars);
}

SplatAppearance LayerAppearance::of(std::size_t i, BakeCounts& counts) const {
    const ShadedSplats& splats = *layer_.splats;
    SplatAppearance seen;
    seen.place = layer_.world_from_layer * (layer_.scale * glm::dvec3(splats.position[i])) + layer_.translate;
    seen.sigma = profile_.sigma * splats.radius[i] * layer_.scale;
    const float s = std::min(1.0f, splats.alpha[i] * layer_.render.opacity);
    glm::vec3 color = splats.color[i];
    if (splats.encoded)
        for (int k = 0; k < 3; ++k) color[k] = static_cast<float>(real::srgb_to_linear(color[k]));
    const Blended blend = blended(color, s, seen.place, counts);
    seen.shows = profile_.peak * s;
    seen.hides = profile_.peak * blend.hides;
    seen.light = profile_.peak * glm::dvec3(blend.light);
    return seen;
}

glm::dmat3 LayerAppearance::axes_of(std::size_t i) const {
    const ShadedSplats& splats = *layer_.splats;
    return splats.stretch.empty() ? layer_.world_from_layer
                                  : layer_.world_from_layer * glm::dmat3(splats.stretch[i]);
}

LayerAppearance::Blended LayerAppearance::blended(const glm::vec3& color, float s, const glm::dvec3& place,
                                                  BakeCounts& counts) const {
    const LayerRender& r = layer_.render;
    const int blend = static_cast<int>(r.blend);
    if (r.holdout) return {s, glm::vec3(0.0f)};
    if (shared::blend_absorbs(blend, color.x)) {
        ++counts.dust;
        double let_through = 0.0;
        for (int k = 0; k < 3; ++k)
            let_through += real::pow(1.0 - s, shared::blend_exponent(blend, color[k], r.absorb[k])) / 3.0;
        return {static_cast<float>(1.0 - let_through), glm::vec3(0.0f)};
    }
    const glm::vec3 light = s * gain_ * color;
    const float bright = std::min(1.0f, std::max({color.x, color.y, color.z}) * gain_);
    return {s * shared::blend_occlusion(blend, bright, hybrid(place)), light};
}

float LayerAppearance::hybrid(const glm::dvec3& place) const {
    if (layer_.render.blend != Blend::hybrid) return 0.0f;
    return shared::hybrid_amount(static_cast<float>(std::abs(glm::dot(axis_, direction_to(camera_, place)))),
                                 layer_.render.hybrid_from_deg, layer_.render.hybrid_to_deg);
}

}  // namespace astrosplat
