// Layers are found by their place, tracks by the layer's name in their key.
#include "edit/layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "edit/keyframes.h"
#include "edit/new_from_file.h"
#include "scene/animate.h"
#include "scene/check.h"
#include "scene/load.h"
#include "scene/new_scene.h"
#include "scene/parameter.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

bool belongs_to(const Track& track, const std::string& layer) { return track.key.layer() == layer; }

fs::path place_of(const Scene& scene) {
    return scene.file.empty() ? fs::absolute("untitled.toml") : scene.file;
}

/// Those of a scene's text, under names that are free; gives the place of the first.
std::size_t add_layers(Scene& scene, const std::string& text, const fs::path& place) {
    const std::size_t first = scene.layers.size();
    std::vector<LayerParams> layers = parse_scene(text, place).layers;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::string name = free_layer_name(scene, layers[i].name);
        for (std::size_t k = i + 1; k < layers.size(); ++k)
            if (layers[k].source.stars.like == layers[i].name) layers[k].source.stars.like = name;
        layers[i].name = name;
        scene.layers.push_back(std::move(layers[i]));
    }
    return first;
}

void rekey(Track& track, const std::string& from, const std::string& to) {
    track.key = track.key.moved(layer_key(from), layer_key(to));
}

const std::string& name_of(const Document& document, std::size_t index) {
    return document.scene().layers.at(index).name;
}

}  // namespace

const LayerParams* find_layer(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.layers, name, &LayerParams::name);
    return found == scene.layers.end() ? nullptr : &*found;
}

std::string free_layer_name(const Scene& scene, const std::string& wanted) {
    const std::string name = layer_name_of(wanted);
    if (!find_layer(scene, name)) return name;
    for (int number = 2;; ++number) {
        const std::string numbered = fmt::format("{}_{}", name, number);
        if (!find_layer(scene, numbered)) return numbered;
    }
}

std::size_t add_layer(Scene& scene, const fs::path& file) {
    const fs::path place = place_of(scene);
    return add_layers(scene, scene_text_for(file, place), place);
}

std::size_t add_shape(Scene& scene, const std::string& shape) {
    return add_layers(scene, shape_scene_text(shape), place_of(scene));
}

std::size_t duplicate_layer(Scene& scene, std::size_t index) {
    LayerParams copy = scene.layers.at(index);
    const std::string original = copy.name;
    copy.name = free_layer_name(scene, original);
    std::vector<Track> tracks;
    for (const Track& track : scene.animation) {
        if (!belongs_to(track, original)) continue;
        tracks.push_back(track);
        rekey(tracks.back(), original, copy.name);
    }
    scene.animation.insert(scene.animation.end(), tracks.begin(), tracks.end());
    scene.layers.insert(scene.layers.begin() + static_cast<std::ptrdiff_t>(index) + 1, std::move(copy));
    return index + 1;
}

void remove_layer(Scene& scene, std::size_t index) {
    const std::string name = scene.layers.at(index).name;
    std::erase_if(scene.animation, [&](const Track& track) { return belongs_to(track, name); });
    scene.layers.erase(scene.layers.begin() + static_cast<std::ptrdiff_t>(index));
}

void move_layer(Scene& scene, std::size_t from, std::size_t to) {
    LayerParams moved = scene.layers.at(from);
    scene.layers.erase(scene.layers.begin() + static_cast<std::ptrdiff_t>(from));
    to = std::min(to, scene.layers.size());
    scene.layers.insert(scene.layers.begin() + static_cast<std::ptrdiff_t>(to), std::move(moved));
}

void rename_layer(Scene& scene, std::size_t index, const std::string& name) {
    LayerParams& layer = scene.layers.at(index);
    if (layer.name == name) return;
    check_layer_name(name, layer.name);
    if (find_layer(scene, name))
        throw InputError(
            fmt::format("{}: layer.name: expected each name once, found '{}' twice", layer.name, name));
    for (Track& track : scene.animation)
        if (belongs_to(track, layer.name)) rekey(track, layer.name, name);
    for (LayerParams& other : scene.layers)
        if (other.source.stars.like == layer.name) other.source.stars.like = name;
    layer.name = name;
}

bool is_visible(const Scene& scene, std::size_t index, double frame) {
    return scene_at(scene, frame).layers.at(index).visible;
}

void toggle_visible(Document& document, const ViewState& view, std::size_t index) {
    const bool visible = is_visible(document.scene(), index, view.frame);
    const std::string name = name_of(document, index), key = layer_key(name) / "visible";
    document.edit((visible ? "Hide " : "Show ") + name, [&](Scene& scene) {
        if (is_animated(scene, key))
            set_keyframe(scene, key, view.frame, !visible);
        else
            scene.layers[index].visible = !visible;
    });
}

void duplicate_layer(Document& document, ViewState& view, std::size_t index) {
    std::size_t copy = index;
    document.edit("Duplicate " + name_of(document, index),
                  [&](Scene& scene) { copy = duplicate_layer(scene, index); });
    view.layer = copy;
}

void remove_layer(Document& document, ViewState& view, std::size_t index) {
    document.edit("Remove " + name_of(document, index), [&](Scene& scene) { remove_layer(scene, index); });
    const std::size_t count = document.scene().layers.size();
    view.layer = std::min(view.layer, count == 0 ? 0 : count - 1);
}

void move_layer(Document& document, ViewState& view, std::size_t from, std::size_t to) {
    document.edit("Move " + name_of(document, from), [&](Scene& scene) { move_layer(scene, from, to); });
    view.layer = to;
}

void toggle_solo(ViewState& view, const std::string& layer) {
    if (view.solo.erase(layer) == 0) view.solo.insert(layer);
}

void apply_preset(LayerParams& layer, const fs::path& preset) {
    const fs::path file = fs::absolute(preset);
    const std::string text =
        fmt::format("astrosplat = 1\n[[layer]]\nname = \"preset\"\npreset = {}\n", to_toml(file.string()));
    const LayerParams loaded = parse_unchecked(text, file).layers.at(0);
    layer.look = loaded.look;
    layer.render = loaded.render;
}

}  // namespace astrosplat
