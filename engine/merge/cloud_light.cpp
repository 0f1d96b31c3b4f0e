#include "merge/cloud_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/shared_maths.h"
#include "render/lod.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

/// The level down to which noise shows in the mean over a place so wide: of cells that are narrower than its
/// spread the mean is 1, and a few samples would only miss that.
int level_seen(const CloudPlace& place) {
    const float spread = std::sqrt(glm::dot(place.spread, place.spread) / 3.0f);
    const float octaves_per_unit = 1.44269504f;  // 1 / ln 2
    const float octaves =
        octaves_per_unit * shared::as_log(place.radius / std::max(spread, 0.01f * place.radius));
    return std::max(0, static_cast<int>(std::floor(octaves)) + 3);
}

}  // namespace

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
