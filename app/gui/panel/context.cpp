// Reading through the description, writing through the document.
#include "gui/panel/context.h"

#include "edit/edits.h"
#include "look/prepare.h"
#include "look/shared_look.h"
#include "scene/animate.h"
#include "scene/describer.h"
#include "scene/load.h"

namespace astrosplat::panel {

const LayerStatus& Context::layer_status(std::size_t i) const {
    static const LayerStatus unknown;
    return i < status.layers.size() ? status.layers[i] : unknown;
}

void describe_current(Memory& memory, const Document& document, double frame) {
    Described& d = memory.described;
    if (d.document == &document && d.revision == document.revision() && d.frame == frame && d.scene) return;
    d.document = &document;
    d.revision = document.revision();
    d.frame = frame;
    d.scene = std::make_unique<Scene>(scene_at(document.scene(), frame));
    d.description = describe(*d.scene);
    d.by_key.clear();
    for (const Parameter& parameter : d.description.parameters)
        d.by_key.emplace(parameter.spec.key, &parameter);
}

const Parameter* find(const Context& context, const ParameterKey& key) {
    const auto& by_key = context.memory.described.by_key;
    const auto found = by_key.find(key);
    return found == by_key.end() ? nullptr : found->second;
}

ParameterKey Context::layer_key() const {
    return scene().layers.empty() ? ParameterKey() : astrosplat::layer_key(layer().name);
}

const Value& default_of(Context& context, const ParameterSpec& spec) {
    const auto found = context.memory.defaults.find(spec.generic_key);
    if (found != context.memory.defaults.end()) return found->second;
    return context.memory.defaults.emplace(spec.generic_key, Document::default_value(spec)).first->second;
}

Gesture begin_gesture(Context& context) { return context.memory.gesture = new_gesture(); }

void attempt(Context& context, const ParameterKey& key, const std::function<void()>& change) {
    Memory& memory = context.memory;
    try {
        change();
        memory.error.clear();
    } catch (const InputError& error) {
        memory.error_key = key;
        memory.error = error.what();
        memory.error_revision = context.document.revision();
    }
}

namespace {

// The smallest size drags the largest along, a custom curve begins as the shape it replaces, and so on.

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

namespace {

// A kind of source that begins with a file: whoever wishes for one of them gets both.
struct KindWithFile {
    const char *kind, *key;
    SourceKind value;
};
constexpr KindWithFile kinds_with_file[] = {{"splats", "source.file", SourceKind::splats},
                                            {"stars", "source.catalogue", SourceKind::stars}};

bool has_file(const SourceParams& source, SourceKind kind) {
    return !(kind == SourceKind::splats ? source.file : source.stars.catalogue).empty();
}

/// Stops for a thickness map that has none: red, green and blue, from thick to thin,
/// all with the look's own shape.
std::vector<ThicknessStop> first_thickness_stops(const Look& look) {
    return {{{1.0f, 0.0f, 0.0f}, 1.0f, look.pdf},
            {{0.0f, 1.0f, 0.0f}, 0.66f, look.pdf},
            {{0.0f, 0.0f, 1.0f}, 0.33f, look.pdf}};
}

// Things that are one wish of a person but need more than one parameter, or a file first. True when done.
bool set_specially(Context& context, const Parameter& parameter, const Value& value) {
    const ParameterKey& key = parameter.spec.key;
    if (parameter.spec.generic_key == "layer.look.thickness.map" && value.text() && !value.text()->empty() &&
        context.layer().look.thickness.stops.empty()) {
        const std::size_t layer = context.view.layer;
        edit(context, key, "Thickness map of " + context.layer().name, [&](Scene& scene) {
            Thickness& thickness = scene.layers[layer].look.thickness;
            thickness.map = *value.text();
            thickness.stops = first_thickness_stops(scene.layers[layer].look);
        });
        return true;
    }
    if (parameter.spec.generic_key != "layer.source.kind") return false;
    const auto wanted =
        std::ranges::find_if(kinds_with_file, [&](const auto& k) { return value == Value(k.kind); });
    if (wanted == std::end(kinds_with_file) || has_file(context.layer().source, wanted->value)) return false;
    context.memory.request = context.layer_key() / wanted->key;
    return true;
}

}  // namespace

void set_value(Context& context, const ParameterKey& key, const Value& value, Gesture gesture) {
    const Parameter* parameter = find(context, key);
    if (parameter && set_specially(context, *parameter, value)) return;
    std::vector<Companion> others = companions(context.scene(), key, value);
    const auto of_kind = std::ranges::find_if(kinds_with_file, [&](const auto& k) {
        return key == context.layer_key() / k.key && context.layer().source.kind != k.value;
    });
    const bool sets_kind = of_kind != std::end(kinds_with_file);
    if (sets_kind) others.push_back({key, value});                          // and then the kind
    if (!others.empty() && gesture == 0) gesture = begin_gesture(context);  // all of it is one undo step
    attempt(context, key, [&] {
        for (const Companion& other : others)
            context.document.set(other.key, other.value, context.view.frame, gesture);
        context.document.set(sets_kind ? context.layer_key() / "source.kind" : key,
                             sets_kind ? Value(of_kind->kind) : value, context.view.frame, gesture);
    });
}

void edit(Context& context, const ParameterKey& key, const std::string& name,
          const std::function<void(Scene&)>& change, Gesture gesture) {
    attempt(context, key, [&] { context.document.edit(name, change, gesture); });
}

Value value_from_text(const std::string& text, const ParameterSpec& spec) {
    std::string raw = text;
    const bool verbatim = spec.type == ParameterType::text || spec.type == ParameterType::file ||
                          spec.type == ParameterType::pattern ||
                          (spec.type == ParameterType::files && raw.rfind('[', 0) != 0);
    if (verbatim) return raw;
    const bool number = spec.type == ParameterType::number || spec.type == ParameterType::integer;
    if (number && std::count(raw.begin(), raw.end(), ',') == 1)
        std::replace(raw.begin(), raw.end(), ',', '.');
    const bool list = spec.type == ParameterType::vector || spec.type == ParameterType::position ||
                      spec.type == ParameterType::rotation || spec.type == ParameterType::color;
    if (list && raw.find('[') == std::string::npos && raw.find_first_of("0123456789") != std::string::npos) {
        if (raw.find(',') == std::string::npos) std::replace(raw.begin(), raw.end(), ' ', ',');
        if (raw.find(',') != std::string::npos) raw = "[" + raw + "]";
    }
    if (number && !raw.empty() && raw.front() == '.') raw = "0" + raw;
    return typed_value(raw);
}

}  // namespace astrosplat::panel
