// Loading: TOML -> layers -> presets -> keys of the scene -> tracks -> assignments -> checks, all in a fresh
// Scene that is returned only when everything was right.
#include "scene/load.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/text.h"
#include "scene/camera_file.h"
#include "scene/check.h"
#include "scene/describe.h"
#include "scene/entries.h"

namespace astrosplat {
namespace {

/// A file of keys that hold before a scene's own: the look of a layer, or the output for a kind of screen.
struct PresetFile {
    fs::path file;
    std::string text;
};

/// Throws InputError unless the table says `astrosplat = 1`; where it is not `required`, it may say nothing.
void check_version(const toml::table& table, const std::string& file, bool required) {
    const toml::node* node = table.get("astrosplat");
    if (!node && !required) return;
    if (!node)
        throw InputError(fmt::format("{}: expected a scene that begins with 'astrosplat = 1', found {}", file,
                                     table.empty() ? "an empty file" : "no such line"));
    const auto* version = node->as_integer();
    if (!version || version->get() != 1)
        throw InputError(fmt::format("{}: astrosplat: expected the format version 1, found {}",
                                     place_of(file, node->source()),
                                     version ? std::to_string(version->get()) : kind_of(*node)));
}

/// A file, or the short name of a look of one's own or that comes with the program. Throws InputError.
PresetFile find_look(const fs::path& wanted) {
    std::error_code ignored;
    const fs::path file = find_by_name("looks", wanted), looks = assets_folder("looks");
    if (fs::exists(file, ignored) || looks.empty()) return {file, read_file(file)};
    throw InputError(
        fmt::format("{}: cannot be read: No such file or directory; the looks that come with astrosplat are "
                    "in {}, by name: {}",
                    file.string(), looks.string(), fmt::join(names_in("looks"), ", ")));
}

/// The same for a kind of screen; a scene beside this one may have the short name, too. Throws InputError.
PresetFile find_output_preset(const fs::path& wanted) {
    std::error_code ignored;
    if (wanted.has_extension()) return {wanted, read_file(wanted)};
    const fs::path name = wanted.filename().string() + ".toml";
    for (const fs::path& place : {own_assets_folder("masters"), assets_folder("masters")})
        if (fs::is_regular_file(place / name, ignored)) return {place / name, read_file(place / name)};
    throw InputError(fmt::format("{}: no preset of the output has this name; known are: {}",
                                 wanted.filename().string(), fmt::join(names_in("masters"), ", ")));
}

/// Adds the keys of a table but those that are read elsewhere; `group` and `generic_group` are its own key.
void flatten_all(const toml::table& table, const ParameterKey& group, const ParameterKey& generic_group,
                 std::initializer_list<std::string_view> left_out, const EntryOrigin& origin,
                 std::vector<Entry>& entries) {
    for (const auto& [key, node] : table)
        if (std::ranges::find(left_out, key.str()) == left_out.end())
            flatten(node, group / key.str(), generic_group / key.str(), origin, key.source(), entries);
}

/// Sets the preset's keys in what `describe` lists, anew each time it is called. Throws InputError, and
/// nothing is set then.
void apply_preset(const PresetFile& preset, const std::function<Description()>& describe, Places& places) {
    const std::string file = preset.file.string();
    const toml::table root = parse_toml(preset.text, file);
    check_version(root, file, false);
    const EntryOrigin origin{file, preset.file.parent_path(), false, {}};
    std::vector<Entry> entries;
    flatten_all(root, {}, {}, {"astrosplat"}, origin, entries);
    apply_entries(std::move(entries), origin, describe, places);
}

/// One layer of the file: its table, and what names it in keys.
struct LayerTable {
    const toml::table* table;
    std::string name;
};

std::vector<LayerTable> read_layers(const toml::table& root, const std::string& file) {
    std::vector<LayerTable> layers;
    const toml::node* node = root.get("layer");
    if (!node) return layers;
    const toml::array* array = list_of_tables(*node);
    if (!array)
        throw InputError(fmt::format("{}: layer: expected [[layer]], found {}",
                                     place_of(file, node->source()), kind_of(*node)));
    for (const toml::node& element : *array) {
        const toml::table& table = *element.as_table();
        const toml::node* name = table.get("name");
        const std::string place = place_of(file, name ? name->source() : table.source());
        if (!name) throw InputError(fmt::format("{}: layer: expected a name, found none", place));
        if (!name->is_string())
            throw InputError(
                fmt::format("{}: layer.name: expected a string, found {}", place, kind_of(*name)));
        const std::string text = name->as_string()->get();
        check_layer_name(text, place);
        for (const LayerTable& other : layers)
            if (other.name == text)
                throw InputError(
                    fmt::format("{}: layer.name: expected each name once, found '{}' twice", place, text));
        layers.push_back({&table, text});
    }
    return layers;
}

/// A value typed on the command line: TOML where it is TOML, otherwise the text itself.
toml::table parse_raw(const std::string& raw) {
    try {
        toml::table table = toml::parse(std::string_view("value = " + raw));
        if (table.size() == 1 && raw.find('\n') == std::string::npos) return table;
    } catch (const toml::parse_error&) {
        // a bare word
    }
    if (const std::optional<double> number = parse_double(raw); number && raw.find('.') != std::string::npos)
        return toml::table{{"value", *number}};  // ".5" and "5.", which people write and TOML does not take
    return toml::table{{"value", raw}};
}

class Loader {
  public:
    Loader(std::string file, fs::path folder) : file_(std::move(file)), folder_(std::move(folder)) {}

    PlacedScene load(const toml::table& root, std::span<const Assignment> assignments, bool checked) {
        check_version(root, file_, true);
        const std::vector<LayerTable> layers = read_layers(root, file_);
        for (const LayerTable& layer : layers) scene_.layers.emplace_back().name = layer.name;
        for (std::size_t i = 0; i < layers.size(); ++i) load_preset(layers[i], scene_.layers[i], assignments);
        load_output_preset(root);
        read_keys(root, layers);
        if (const toml::node* animation = root.get("animation")) {
            if (!animation->is_table())
                throw InputError(fmt::format("{}: animation: expected a table, found {}",
                                             place_of(file_, animation->source()), kind_of(*animation)));
            scene_.animation = read_tracks(*animation->as_table(), scene_, file_);
        }
        for (const Assignment& assignment : assignments) assign(assignment);
        if (checked) check_scene(scene_, file_, places_);
        return {std::move(scene_), std::move(places_)};
    }

  private:
    void apply(std::vector<Entry> entries, const EntryOrigin& origin) {
        apply_entries(
            std::move(entries), origin, [this] { return describe(scene_); }, places_);
    }

    void load_preset(const LayerTable& source, LayerParams& layer, std::span<const Assignment> assignments) {
        const ParameterKey key = layer_key(layer.name) / "preset";
        EntryOrigin origin{file_, folder_};
        std::vector<Entry> entries;
        toml::table assigned;
        std::string raw;
        if (const toml::node* node = source.table->get("preset"))
            flatten(*node, key, "layer.preset", origin, node->source(), entries);
        for (const Assignment& assignment : assignments) {
            if (assignment.key != key) continue;
            raw = assignment.value;
            assigned = parse_raw(raw);
            origin = {"--set", "", true, layer_key(layer.name)};
            entries = {{Entry::Kind::leaf, key, "layer.preset", "--set", {}, assigned.get("value"), &raw}};
        }
        apply(entries, origin);
        if (!layer.preset.empty()) read_preset(layer);
    }

    void read_preset(LayerParams& layer) {
        Places places;
        apply_preset(
            find_look(layer.preset), [&] { return describe_preset(layer.look, layer.render); }, places);
        for (const auto& [key, place] : places) places_[layer_key(layer.name) / key] = place;
    }

    /// Before the scene's own keys, which win.
    void load_output_preset(const toml::table& root) {
        const toml::node* node = root.at_path("output.preset").node();
        if (!node) return;
        const EntryOrigin origin{file_, folder_};
        std::vector<Entry> entries;
        flatten(*node, "output.preset", "output.preset", origin, node->source(), entries);
        apply(entries, origin);
        read_output_preset();
    }

    void read_output_preset() {
        if (scene_.output.preset.empty()) return;
        const auto of_the_screen = [](const ParameterKey& group) {
            return group == "output" || group == "camera";
        };
        apply_preset(
            find_output_preset(scene_.output.preset), [&] { return describe(scene_, of_the_screen); },
            places_);
    }

    void read_keys(const toml::table& root, const std::vector<LayerTable>& layers) {
        const EntryOrigin origin{file_, folder_};
        std::vector<Entry> entries;
        flatten_all(root, {}, {}, {"astrosplat", "layer", "animation"}, origin, entries);
        for (const LayerTable& layer : layers) {
            const ParameterKey group = layer_key(layer.name);
            places_[group] = place_of(file_, layer.table->source());
            // The preset was read before everything else, and may have been replaced by --set.
            flatten_all(*layer.table, group, "layer", {"preset"}, origin, entries);
        }
        apply(std::move(entries), origin);
    }

    void assign(const Assignment& assignment) {
        const toml::table value = parse_raw(assignment.value);
        const toml::node& node = *value.get("value");
        const ParameterKey& key = assignment.key;
        if (key.is_below("animation")) {
            Track track = read_track(key.below("animation"), node, scene_, "--set");
            overrule(track.key);
            scene_.animation.push_back(std::move(track));
            return;
        }
        const std::string layer = key.layer();
        if (!layer.empty() &&
            std::ranges::find(scene_.layers, layer, &LayerParams::name) == scene_.layers.end())
            throw InputError("--set: " + why_unknown(scene_, key));
        if (key == layer_key(layer) / "name") {
            rename_layer(layer, node.is_string() ? node.as_string()->get() : assignment.value);
            return;
        }
        const EntryOrigin origin{"--set", "", true, layer.empty() ? "layer" : layer_key(layer)};
        std::vector<Entry> entries;
        flatten(node, key, key, origin, {}, entries);
        for (Entry& entry : entries) {
            entry.place = "--set";
            if (entry.key == key) entry.raw = &assignment.value;
        }
        apply(entries, origin);
        for (const Entry& entry : entries)
            if (overrule(full_key(describe(scene_), entry.key)))
                log_info(fmt::format("--set {} replaces its animation", entry.key));
        if (key == "output.preset") read_output_preset();
    }

    void rename_layer(const std::string& from, const std::string& to) {
        check_layer_name(to, "--set");
        for (LayerParams& layer : scene_.layers) {
            if (layer.name == to && to != from)
                throw InputError(
                    fmt::format("--set: layer.name: expected each name once, found '{}' twice", to));
            if (layer.name == from) layer.name = to;
            if (layer.source.stars.like == from) layer.source.stars.like = to;
        }
        for (Track& track : scene_.animation)
            if (track.key.layer() == from) track.key = track.key.moved(layer_key(from), layer_key(to));
    }

    /// --set wins over what moves a parameter, [animation] here and camera.file when that is read, and over a
    /// parameter that replaces it. Whether there was animation.
    bool overrule(const ParameterKey& key) {
        if (key == "camera.fov") {
            scene_.camera.focal_length = 0.0;
            drop_tracks("camera.focal_length");
        } else if (key == "camera.target") {
            scene_.camera.rotation.reset();
            drop_tracks("camera.rotation");
        }
        return drop_tracks(key);
    }

    bool drop_tracks(const ParameterKey& key) {
        scene_.imported.overruled.push_back(key);
        return std::erase_if(scene_.animation, [&](const Track& track) { return track.key == key; }) > 0;
    }

    std::string file_;
    fs::path folder_;
    Scene scene_;
    Places places_;
};

}  // namespace

Assignment parse_assignment(const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string_view key = trim(std::string_view(text).substr(0, equals));
    if (key.empty() || equals == text.size())
        throw InputError(fmt::format("--set: expected KEY=VALUE, found '{}'", text));
    return {key, std::string(trim(std::string_view(text).substr(equals + 1)))};
}

static PlacedScene parse(const std::string& toml, const fs::path& file,
                         std::span<const Assignment> assignments, bool checked) {
    const toml::table root = parse_toml(toml, file.string());
    PlacedScene placed = Loader(file.string(), file.parent_path()).load(root, assignments, checked);
    placed.scene.file = file;
    if (checked) attach_camera_file(placed.scene, place_of(placed.places, "camera.file", file.string()));
    return placed;
}

Scene parse_scene(const std::string& toml, const fs::path& file, std::span<const Assignment> assignments) {
    return parse(toml, file, assignments, true).scene;
}

Scene parse_unchecked(const std::string& toml, const fs::path& file) {
    return parse(toml, file, {}, false).scene;
}

Value typed_value(const std::string& text) {
    const toml::table table = parse_raw(text);
    try {
        return value_of(*table.get("value"));
    } catch (const ValueError&) {
        return text;
    }
}

PlacedScene load_placed(const fs::path& file, std::span<const Assignment> assignments) {
    const fs::path found = find_by_name("scenes", file);
    const FileFormat* const format = format_of_file(found);
    if (kind_of(format) >= FileKind::picture) bad_input(found, "a scene", std::string(format->name));
    return parse(read_file(found), found, assignments, true);
}

Scene load_scene(const fs::path& file, std::span<const Assignment> assignments) {
    return load_placed(file, assignments).scene;
}

}  // namespace astrosplat
