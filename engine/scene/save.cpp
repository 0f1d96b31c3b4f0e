// Saving: brings layers, then tracks, lists and single keys of the original text in line with the scene,
// comparing with what the text says at each step.
#include "scene/save.h"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "scene/describe.h"
#include "scene/entries.h"
#include "scene/load.h"
#include "scene/parameter.h"
#include "scene/toml_text.h"

namespace astrosplat {
namespace {

/// The default of an element's parameter.
const Value& standard_value(const ParameterKey& generic_key) {
    for (const ParameterRow& row : parameter_rows())
        if (row.spec.key == generic_key) return row.value;
    throw std::logic_error("no parameter " + generic_key.text());
}

/// Edits one text until it says what a scene or preset says.
class Saver {
  public:
    Saver(std::string text, std::vector<std::string> layers, fs::path folder)
        : text_(std::move(text)), layers_(std::move(layers)), folder_(std::move(folder)) {}

    TomlText& text() { return text_; }

    /// Where a full key stands: layers by index; a list given as a single table has no index.
    TomlPath path_of(const ParameterKey& key, const Description& description) const {
        TomlPath path = key.parts();
        if (path[0] == "layer" && path.size() > 1) path[1] = layer_index(path[1]);
        for (const ParameterList& list : description.lists) {
            if (!key.is_below(list.key / 0)) continue;
            const std::size_t size = list.key.parts().size();
            const TomlPath indexed(path.begin(), path.begin() + std::ptrdiff_t(size) + 1);
            const TomlPath bare(indexed.begin(), indexed.end() - 1);
            if (!text_.contains(indexed) && text_.contains(bare))
                path.erase(path.begin() + std::ptrdiff_t(size));
        }
        return path;
    }

    void set(const Parameter& parameter, const Description& description) {
        const ParameterSpec& spec = parameter.spec;
        const TomlPath path = path_of(spec.key, description);
        text_.set(path, section_size(spec.generic_key, path),
                  to_toml(unresolve_paths(parameter.get(), spec, folder_)));
    }

    /// Writes lists whose length differs, or that the text does not have, as a whole.
    void set_lists(const Description& base, const Description& wanted) {
        for (const ParameterList& list : wanted.lists) {
            const auto old = std::ranges::find(base.lists, list.key, &ParameterList::key);
            const bool written = text_.contains(path_of(list.key, wanted));
            const bool is_new = old == base.lists.end();  // within an element that was just written
            if (is_new && (written || list.size() == 0)) continue;
            const bool same_length = !is_new && old->size() == list.size();
            if (same_length && (written || same_elements(list.key, base, wanted))) continue;
            const TomlPath path = path_of(list.key, wanted);
            if (!text_.is_value(path)) text_.remove(path);
            text_.set(path, section_size(list.generic_key, path), list_text(list, wanted));
        }
    }

    void set_values(const Description& base, const Description& wanted) {
        for (const Parameter& parameter : wanted.parameters) {
            const Parameter* old = find_parameter(base, parameter.spec.key);
            if (!old || !(old->get() == parameter.get())) set(parameter, wanted);
        }
    }

  private:
    std::string layer_index(const std::string& name) const {
        return std::to_string(std::ranges::find(layers_, name) - layers_.begin());
    }

    /// Parts of `path` that are its header's: lists of tables have an index there, unless they are one table.
    static std::size_t section_size(const ParameterKey& generic_key, const TomlPath& path) {
        const ParameterKey section = section_of(generic_key);
        const bool is_list = section == "layer" || section.is_below("layer") || section == "reference";
        return std::min(section.parts().size() + (is_list ? 1 : 0), path.size() - 1);
    }

    static bool same_elements(const ParameterKey& list, const Description& base, const Description& wanted) {
        return std::ranges::all_of(wanted.parameters, [&](const Parameter& parameter) {
            if (!parameter.spec.key.is_below(list)) return true;
            const Parameter* old = find_parameter(base, parameter.spec.key);
            return old && old->get() == parameter.get();
        });
    }

    std::string list_text(const ParameterList& list, const Description& description) const {
        std::string text;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string pairs = element_pairs(list.key / i, description);
            text += (text.empty() ? "" : ", ") + (pairs.empty() ? "{}" : "{ " + pairs + " }");
        }
        return "[" + text + "]";
    }

    /// The values of a list's element that are not the default: "luminance = [0.1, 1.0], any = [{ ... }]".
    std::string element_pairs(const ParameterKey& element, const Description& description) const {
        std::string pairs;
        const auto add = [&](std::string_view name, const std::string& text) {
            pairs += fmt::format("{}{} = {}", pairs.empty() ? "" : ", ", name, text);
        };
        std::vector<const ParameterList*> inner;
        for (const ParameterList& list : description.lists)
            if (list.key.is_below(element) && list.size() > 0) inner.push_back(&list);
        for (const Parameter& parameter : description.parameters) {
            const ParameterSpec& spec = parameter.spec;
            const auto holds = [&](const ParameterList* list) { return spec.key.is_below(list->key); };
            if (!spec.key.is_below(element) || std::ranges::any_of(inner, holds)) continue;
            const Value value = parameter.get();
            const bool of_preset = spec.generic_key.is_below("look");
            if (!(value ==
                  standard_value(of_preset ? ParameterKey("layer") / spec.generic_key : spec.generic_key)))
                add(spec.key.below(element), to_toml(unresolve_paths(value, spec, folder_)));
        }
        for (const ParameterList* list : inner) add(list->key.below(element), list_text(*list, description));
        return pairs;
    }

    TomlText text_;
    std::vector<std::string> layers_;
    fs::path folder_;
};

/// A layer that is new at the place of one that is gone was renamed.
void rename_layers(TomlText& text, std::vector<std::string>& old, const std::vector<std::string>& wanted) {
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
        return std::ranges::find(names, name) != names.end();
    };
    for (std::size_t i = 0; i < std::min(old.size(), wanted.size()); ++i) {
        if (old[i] == wanted[i] || has(old, wanted[i]) || has(wanted, old[i])) continue;
        text.set({"layer", std::to_string(i), "name"}, 2, to_toml(wanted[i]));
        old[i] = wanted[i];
    }
}

/// Adds, removes and reorders whole [[layer]] parts.
void arrange_layers(TomlText& text, std::vector<std::string> old, const std::vector<std::string>& wanted) {
    rename_layers(text, old, wanted);
    if (old == wanted) return;
    std::map<std::string, std::string> blocks;
    std::size_t at = std::string::npos, begin = 0;
    for (std::size_t i = old.size(); i-- > 0;) {  // from the last, so that indices stay
        blocks[old[i]] = text.cut_block({"layer", std::to_string(i)}, begin);
        at = std::min(at, begin);
    }
    text.remove({"layer"});  // layer = [ { ... } ]
    std::string all;
    for (const std::string& name : wanted) {
        const auto block = blocks.find(name);
        const bool written = block != blocks.end() && !block->second.empty();
        if (!all.empty() && all.back() != '\n') all += "\n";
        all += written ? block->second : fmt::format("\n[[layer]]\nname = {}\n", to_toml(name));
    }
    at = std::min(at, text.text().size());
    if (at > 0 && text.text()[at - 1] != '\n') all = "\n" + all;
    text.insert(at, all);
}

/// Takes out the tracks that the scene lacks, all of them when their order differs.
void remove_tracks(TomlText& text, const Scene& scene, const Description& wanted) {
    std::vector<ParameterKey> kept;
    for (const std::string& name : text.children({"animation"})) {
        const ParameterKey key = full_key(wanted, name);
        const bool stays = std::ranges::find(scene.animation, key, &Track::key) != scene.animation.end();
        if (stays)
            kept.push_back(key);
        else
            text.remove({"animation", name});
    }
    // New tracks come after those that are there.
    const bool in_order =
        std::equal(kept.begin(), kept.end(), scene.animation.begin(),
                   [](const ParameterKey& key, const Track& track) { return key == track.key; });
    if (in_order) return;
    for (const std::string& name : text.children({"animation"})) text.remove({"animation", name});
}

void set_tracks(TomlText& text, const Scene& base, const Scene& scene, const Description& wanted) {
    for (const Track& track : scene.animation) {
        if (std::ranges::find(base.animation, track) != base.animation.end()) continue;
        const Parameter* parameter = find_parameter(wanted, track.key);
        if (!parameter) continue;
        std::string name = track.key;
        for (const std::string& written : text.children({"animation"}))
            if (full_key(wanted, written) == track.key) name = written;
        if (!text.is_value({"animation", name})) text.remove({"animation", name});
        text.set({"animation", name}, 1, track_to_toml(track, parameter->spec));
    }
}

/// Where the file moves to another folder, paths in the text still mean the same files.
void rebase_paths(Saver& saver, const std::string& original, const fs::path& from, const fs::path& to) {
    if (original.empty() || from.empty() || from.parent_path() == to.parent_path()) return;
    Scene scene = parse_unchecked(original, from);
    const Description description = describe(scene);
    for (const Parameter& parameter : description.parameters) {
        const ParameterType type = parameter.spec.type;
        if (type != ParameterType::file && type != ParameterType::files) continue;
        if (saver.text().contains(saver.path_of(parameter.spec.key, description)))
            saver.set(parameter, description);
    }
}

/// Presets come first: they change what the other keys start from.
void set_presets(Saver& saver, const Scene& before, const Scene& scene, const Description& wanted) {
    if (before.output.preset != scene.output.preset)
        saver.set(*find_parameter(wanted, "output.preset"), wanted);
    for (const LayerParams& layer : scene.layers) {
        const auto old = std::ranges::find(before.layers, layer.name, &LayerParams::name);
        if (old == before.layers.end() ? layer.preset.empty() : old->preset == layer.preset) continue;
        saver.set(*find_parameter(wanted, layer_key(layer.name) / "preset"), wanted);
    }
}

}  // namespace

std::string save_text(const Scene& scene, const std::string& original, const fs::path& file) {
    Scene target = scene;
    target.file = file;
    const std::vector<std::string> names = layer_names(target);
    std::string text = original.empty() ? "astrosplat = 1\n" : original;
    const Scene before = parse_unchecked(text, scene.file.empty() || original.empty() ? file : scene.file);
    Saver old(text, layer_names(before), file.parent_path());
    rebase_paths(old, original, scene.file, file);
    arrange_layers(old.text(), layer_names(before), names);

    Saver saver(old.text().text(), names, file.parent_path());
    const Description wanted = describe(target);
    remove_tracks(saver.text(), target, wanted);
    set_presets(saver, before, target, wanted);
    Scene base = parse_unchecked(saver.text().text(), file);
    saver.set_lists(describe(base), wanted);
    base = parse_unchecked(saver.text().text(), file);
    saver.set_values(describe(base), wanted);
    set_tracks(saver.text(), base, target, wanted);
    return saver.text().text();
}

std::string save_preset_text(const Look& look, const LayerRender& render, const fs::path& file) {
    Look wanted_look = look, base_look;
    LayerRender wanted_render = render, base_render;
    Saver saver("astrosplat = 1\n", {}, file.parent_path());
    const Description wanted = describe_preset(wanted_look, wanted_render);
    saver.set_lists(describe_preset(base_look, base_render), wanted);
    base_look.noise = look.noise;
    base_look.crop = look.crop;
    base_look.thickness.stops = look.thickness.stops;
    saver.set_values(describe_preset(base_look, base_render), wanted);
    return saver.text().text();
}

}  // namespace astrosplat
