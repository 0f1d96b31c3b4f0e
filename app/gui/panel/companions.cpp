// The smallest size drags the largest along, a custom curve begins as the shape it replaces, and so on.
#include "gui/panel/companions.h"

#include <algorithm>
#include <charconv>

#include "gui/panel/words.h"
#include "look/prepare.h"
#include "look/shared_look.h"
#include "scene/field.h"

namespace astrosplat::panel {
namespace {

using Result = std::vector<Companion>;

bool is_word(const Value& value, const char* word) { return value.text() && *value.text() == word; }

// Five points of a profile, enough to look like it.
Value sampled(const LookProfile& profile) {
    std::vector<glm::vec2> points;
    for (const float x : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        const double y = double(shared::look_profile(profile, x));
        points.emplace_back(x, static_cast<float>(rounded_to_step(y, 1e-3)));
    }
    return curve_value(points);
}

Result density_points(const DensityCurve& pdf, const std::string& head) {
    if (pdf.points.size() >= 2) return {};
    return {{head + "points", sampled(density_profile(pdf, "points"))}};
}

Result points_for_shape(const LayerParams& layer, const std::string& head, const std::string& rest) {
    const Look& look = layer.look;
    if (rest == "look.pdf.shape") return density_points(look.pdf, head + "look.pdf.");
    if (rest == "look.vertical.shape") {
        if (look.vertical.points.size() >= 2) return {};
        return {{head + "look.vertical.points", sampled(vertical_profile(look.vertical))}};
    }
    const std::string list = "look.thickness.keys.";
    std::size_t index = look.thickness.keys.size();
    if (rest.rfind(list, 0) == 0)
        std::from_chars(rest.data() + list.size(), rest.data() + rest.size(), index);
    if (index >= look.thickness.keys.size()) return {};
    return density_points(look.thickness.keys[index].pdf, head + list + std::to_string(index) + ".");
}

// Two numbers of which the first may not be above the second: the other one follows. `gap` apart at least.
struct Pair {
    const char* lower;
    const char* upper;
    double gap;
};

Result follow(const Pair& pair, double lower, double upper, const std::string& head, const std::string& rest,
              double value) {
    if (rest == pair.lower && value + pair.gap > upper) return {{head + pair.upper, value + pair.gap}};
    if (rest == pair.upper && value - pair.gap < lower) return {{head + pair.lower, value - pair.gap}};
    return {};
}

Result of_source(const SourceParams& source, const std::string& head, const std::string& rest,
                 const Value& value) {
    if (rest == "source.voxels" && value.list() && source.voxel_size > 0.0)
        return {{head + "source.voxel_size", 0.0}};
    if (rest == "source.kind" && is_word(value, "mesh") && source.meshes.empty())
        return {{head + "source.meshes.0.mesh", "plane"}};
    return {};
}

Result of_layer(const LayerParams& layer, const std::string& head, const std::string& rest,
                const Value& value) {
    if (is_word(value, "curve")) return points_for_shape(layer, head, rest);
    const Radius& radius = layer.look.radius;
    const LayerRender& render = layer.render;
    if (value.is_number() && rest.rfind("look.radius.", 0) == 0)
        return follow({"look.radius.min", "look.radius.max", 0.0}, widen(radius.min), widen(radius.max), head,
                      rest, value.number());
    if (value.is_number() && rest.rfind("render.hybrid.", 0) == 0)
        return follow({"render.hybrid.from_deg", "render.hybrid.to_deg", 1.0}, widen(render.hybrid_from_deg),
                      widen(render.hybrid_to_deg), head, rest, value.number());
    return of_source(layer.source, head, rest, value);
}

}  // namespace

std::vector<Companion> companions(const Scene& scene, const std::string& key, const Value& value) {
    const EnvironmentParams& environment = scene.environment;
    if (key == "environment.image" && !environment.cube.empty()) return {{"environment.cube", Value::List{}}};
    if (key == "environment.cube" && !environment.image.empty()) return {{"environment.image", ""}};
    for (const LayerParams& layer : scene.layers) {
        const std::string head = "layer." + layer.name + ".";
        if (key.rfind(head, 0) == 0) return of_layer(layer, head, key.substr(head.size()), value);
    }
    return {};
}

std::vector<ThicknessKey> first_thickness_keys(const Look& look) {
    return {{{1.0f, 0.0f, 0.0f}, 1.0f, look.pdf},
            {{0.0f, 1.0f, 0.0f}, 0.66f, look.pdf},
            {{0.0f, 0.0f, 1.0f}, 0.33f, look.pdf}};
}

}  // namespace astrosplat::panel
