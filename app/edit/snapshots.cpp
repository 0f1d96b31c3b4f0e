// Layers are matched by name, tracks by their key.
#include "edit/snapshots.h"

#include <algorithm>

namespace astrosplat {
namespace {

const LayerParams* find_layer(const Scene& scene, const std::string& name) {
    const auto found = std::find_if(scene.layers.begin(), scene.layers.end(),
                                    [&](const LayerParams& layer) { return layer.name == name; });
    return found == scene.layers.end() ? nullptr : &*found;
}

/// Whether a key is part of the look of a layer that both scenes have.
bool is_of_look(const ParameterKey& key, const Scene& scene, const Scene& stored) {
    if (key == "output.exposure") return true;
    const std::string name = key.layer();
    const ParameterKey layer = layer_key(name);
    const bool look =
        key.is_below(layer / "look") || key.is_below(layer / "render") || key == layer / "visible";
    return look && find_layer(scene, name) && find_layer(stored, name);
}

}  // namespace

StoredLook store_look(const std::string& name, const Document& document, double frame) {
    return {name, std::make_shared<const Scene>(document.scene()), frame};
}

Scene with_look_of(const Scene& scene, const Scene& stored) {
    Scene result = scene;
    result.output.exposure = stored.output.exposure;
    for (LayerParams& layer : result.layers) {
        const LayerParams* old = find_layer(stored, layer.name);
        if (!old) continue;
        layer.look = old->look;
        layer.render = old->render;
        layer.visible = old->visible;
    }
    // A track that both have keeps its place in the list, so that going back and forth changes nothing else.
    std::vector<Track> tracks;
    const auto find = [](const std::vector<Track>& list, const ParameterKey& key) {
        return std::find_if(list.begin(), list.end(), [&](const Track& t) { return t.key == key; });
    };
    for (const Track& track : scene.animation) {
        const auto old = find(stored.animation, track.key);
        if (!is_of_look(track.key, scene, stored))
            tracks.push_back(track);
        else if (old != stored.animation.end())
            tracks.push_back(*old);
    }
    for (const Track& track : stored.animation)
        if (is_of_look(track.key, scene, stored) && find(tracks, track.key) == tracks.end())
            tracks.push_back(track);
    result.animation = std::move(tracks);
    return result;
}

void restore_look(Document& document, const StoredLook& stored) {
    document.edit("Restore " + stored.name,
                  [&](Scene& scene) { scene = with_look_of(scene, *stored.scene); });
}

}  // namespace astrosplat
