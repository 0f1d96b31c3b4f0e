// The smallest size drags the largest along, a custom curve begins as the shape it replaces, and so on.
#include "gui/panel/companions.h"

#include "gui/panel/words.h"
#include "look/prepare.h"
#include "look/shared_look.h"
#include "scene/describer.h"

namespace astrosplat::panel {
namespace {

using Result = std::vector<Companion>;

// Five points of a profile, enough to look like it.
Value sampled(const LookProfile& profile) {
    std::vector<glm::vec2> points;
    for (const float x : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        const double y = double(shared::look_profile(profile, x));
        points.emplace_back(x, static_cast<float>(rounded_to_step(y, 1e-3)));
    }
    return curve_value(points);
}

/// A curve is first what the shape before it was; `key` is the shape's.
Result points_for_shape(const Look& look, const ParameterKey& key) {
    const ParameterKey generic = key.generic(), points = key.parent() / "points";
    const auto of_density = [&](const DensityCurve& pdf) -> Result {
        if (pdf.points.size() >= 2) return {};
        return {{points, sampled(density_profile(pdf, "points"))}};
    };
    if (generic == "layer.look.pdf.shape") return of_density(look.pdf);
    if (generic == "layer.look.thickness.keys.shape")
        return of_density(look.thickness.stops.at(place_in_list(key)).pdf);
    if (generic == "layer.look.vertical.shape" && look.vertical.points.size() < 2)
        return {{points, sampled(vertical_profile(look.vertical))}};
    return {};
}

/// Two numbers of which the first may not be above the second: the other one follows. `gap` apart at least.
struct Pair {
    ParameterKey lower, upper;
    double lower_value, upper_value, gap;
};

Result follow(const Pair& pair, const ParameterKey& key, const Value& value) {
    if (!value.is_number()) return {};
    const double number = value.number();
    if (key == pair.lower && number + pair.gap > pair.upper_value) return {{pair.upper, number + pair.gap}};
    if (key == pair.upper && number - pair.gap < pair.lower_value) return {{pair.lower, number - pair.gap}};
    return {};
}

Result of_source(const SourceParams& params, const ParameterKey& source, const ParameterKey& key,
                 const Value& value) {
    if (key == source / "voxels" && value.list() && params.voxel_size > 0.0)
        return {{source / "voxel_size", 0.0}};
    if (key == source / "splats" && value.is_number() && value.number() > 0.0)
        return {{source / "count", SourceParams().count}};
    if (key == source / "kind" && value == Value("mesh") && params.meshes.empty())
        return {{source / "meshes.0.mesh", "plane"}};
    return {};
}

Result of_layer(const LayerParams& layer, const ParameterKey& group, const ParameterKey& key,
                const Value& value) {
    if (value == Value("curve")) return points_for_shape(layer.look, key);
    if (key.is_below(group / "source")) return of_source(layer.source, group / "source", key, value);
    const ParameterKey radius = group / "look.radius", hybrid = group / "render.hybrid";
    const LayerRender& render = layer.render;
    if (key.is_below(radius))
        return follow(
            {radius / "min", radius / "max", widen(layer.look.radius.min), widen(layer.look.radius.max), 0.0},
            key, value);
    return follow({hybrid / "from_deg", hybrid / "to_deg", widen(render.hybrid_from_deg),
                   widen(render.hybrid_to_deg), 1.0},
                  key, value);
}

}  // namespace

std::size_t place_in_list(const ParameterKey& key) { return std::stoul(key.parent().parts().back()); }

std::vector<Companion> companions(const Scene& scene, const ParameterKey& key, const Value& value) {
    const EnvironmentParams& environment = scene.environment;
    std::vector<Companion> others;
    if (key == "environment.image" || key == "environment.cube" || key == "environment.tile") {
        if (!environment.image.empty()) others.push_back({"environment.image", ""});
        if (!environment.cube.empty()) others.push_back({"environment.cube", Value::List{}});
        if (!environment.tile.empty()) others.push_back({"environment.tile", ""});
        std::erase_if(others, [&](const Companion& other) { return other.key == key; });
        return others;  // one picture at a time
    }
    // Names of another configuration, or of another display, mean nothing.
    const OcioParams& ocio = scene.output.ocio;
    if (key == "output.ocio.config") {
        if (!ocio.display.empty()) others.push_back({"output.ocio.display", ""});
        if (!ocio.space.empty()) others.push_back({"output.ocio.space", ""});
    }
    if ((key == "output.ocio.config" || key == "output.ocio.display") && !ocio.view.empty())
        others.push_back({"output.ocio.view", ""});
    if (key.is_below("output")) return others;
    for (const LayerParams& layer : scene.layers)
        if (const ParameterKey group = layer_key(layer.name); key.is_below(group))
            return of_layer(layer, group, key, value);
    return {};
}

std::vector<ThicknessStop> first_thickness_stops(const Look& look) {
    return {{{1.0f, 0.0f, 0.0f}, 1.0f, look.pdf},
            {{0.0f, 1.0f, 0.0f}, 0.66f, look.pdf},
            {{0.0f, 0.0f, 1.0f}, 0.33f, look.pdf}};
}

}  // namespace astrosplat::panel
