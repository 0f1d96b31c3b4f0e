// Reading through the description, writing through the document.
#include "gui/panel/context.h"

#include <algorithm>

#include "gui/panel/companions.h"
#include "scene/animate.h"
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
    }
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

void reset_value(Context& context, const ParameterKey& key) {
    attempt(context, key, [&] { context.document.reset(key); });
}

void edit(Context& context, const ParameterKey& key, const std::string& name,
          const std::function<void(Scene&)>& change, Gesture gesture) {
    attempt(context, key, [&] { context.document.edit(name, change, gesture); });
}

bool busy(const Memory& memory) {
    return memory.touch.drag != 0 || memory.touch.entry != 0 || memory.dragged_layer >= 0 ||
           !memory.renaming.empty();
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
