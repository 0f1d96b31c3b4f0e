#include "scene/layer_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/rotation.h"
#include "generate/lattice.h"
#include "render/falloff.h"
#include "scene/layer_source.h"

namespace astrosplat {
namespace {

ColumnLaw column_law(Blend blend) {
    switch (blend) {
        case Blend::add:
            return ColumnLaw::sum;
        case Blend::lighten:
            return ColumnLaw::maximum;
        case Blend::screen:
            return ColumnLaw::screen;
        case Blend::over:
        case Blend::hybrid:
        case Blend::absorb:
            return ColumnLaw::transmittance;
    }
    return ColumnLaw::transmittance;
}

StarPsf star_psf(const StarsParams& stars) {
    StarPsf psf;
    psf.core_px = static_cast<float>(stars.psf);
    psf.wing_share = static_cast<float>(stars.wings.share);
    psf.wing_px = static_cast<float>(stars.wings.px);
    psf.wing_power = static_cast<float>(stars.wings.power);
    psf.spike_share = std::min(static_cast<float>(stars.spikes.share), 1.0f - psf.wing_share);
    psf.vanes = stars.spikes.vanes;
    psf.vane_deg = static_cast<float>(stars.spikes.angle);
    psf.spike_px = static_cast<float>(stars.spikes.px);
    return psf;
}

}  // namespace

RenderLayer render_layer(const LayerParams& params) {
    RenderLayer layer;
    layer.name = params.name;
    layer.render = params.render;
    layer.world_from_layer = rotation_from_degrees(params.transform.rotate);
    layer.scale = params.transform.scale;
    layer.translate = params.transform.translate;
    layer.axis = params.axis;
    layer.seed = resolved_seed(params.source.seed, params.name);
    if (params.source.kind == SourceKind::stars) layer.stars = star_psf(params.source.stars);
    return layer;
}

RenderLayer render_layer(const Scene& scene, const LayerParams& params) {
    RenderLayer layer = render_layer(params);
    const LayerParams* const like = like_layer(scene, params);
    if (!like) return layer;
    const RenderLayer under = render_layer(*like);
    layer.translate = under.world_from_layer * (under.scale * layer.translate) + under.translate;
    layer.world_from_layer = under.world_from_layer * layer.world_from_layer;
    layer.scale *= under.scale;
    return layer;
}

Look look_of(const LayerParams& params) {
    if (params.source.kind != SourceKind::stars) return params.look;
    Look look;
    look.grade = params.look.grade;
    return look;
}

LookInputs look_inputs(const LayerParams& params) {
    LookInputs inputs;
    inputs.axis = glm::vec3(params.axis);
    inputs.seed = resolved_seed(params.source.seed, params.name);
    inputs.falloff_integral = falloff_integral(params.render.falloff);
    inputs.falloff_variance = falloff_variance(params.render.falloff);
    inputs.column = column_law(params.render.blend);
    return inputs;
}

Bounds world_bounds(const Bounds& box, const RenderLayer& layer) {
    Bounds result;
    if (box.empty()) return result;
    for (int corner = 0; corner < 8; ++corner)
        result.add(layer.world_from_layer * (layer.scale * box.corner(corner)) + layer.translate);
    return result;
}

void check_extent(const Bounds& box, const std::string& layer, double farthest) {
    if (box.empty()) return;
    for (int axis = 0; axis < 3; ++axis)
        for (const double x : {double(box.lo[axis]), double(box.hi[axis])})
            if (!(std::fabs(x) <= farthest))
                throw InputError(
                    fmt::format("{}: expected splats within {:g} scene units of 0, found one at {:g}",
                                layer_key(layer), farthest, x));
}

bool has_environment(const EnvironmentParams& params) {
    return !params.image.empty() || !params.cube.empty() || !params.tile.empty();
}

}  // namespace astrosplat
