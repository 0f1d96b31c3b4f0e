#include "scene_texts.h"

#include <map>

namespace astrosplat::test {
namespace {

/// The innermost element of a list that a key is of; empty: none.
ParameterKey element_of(const ParameterKey& key, const Description& description) {
    ParameterKey innermost;
    for (const ParameterList& list : description.lists)
        if (key.is_below(list.key / 0)) innermost = list.key / 0;
    return innermost;
}

}  // namespace

Scene scene_of_defaults() {
    Scene scene;
    scene.file = "scene.toml";
    scene.layers.resize(1);
    scene.layers[0].name = "stars";
    for (bool grown = true; grown;) {
        grown = false;
        for (const ParameterList& list : describe(scene).lists)
            if (list.size() == 0) {
                list.resize(1);
                grown = true;
                break;  // the description is out of date
            }
    }
    scene.layers[0].source.meshes[0].mesh = "disk.obj";
    return scene;
}

std::string full_scene() {
    Scene scene = scene_of_defaults();
    const Description description = describe(scene);
    std::string scene_keys, layer_keys;
    std::map<std::string, std::string> elements;  // by header: those within others come after them
    for (const Parameter& parameter : description.parameters) {
        const ParameterKey& key = parameter.spec.key;
        const ParameterKey element = element_of(key, description);
        const bool of_layer = key.is_below("layer");
        std::string& text = !element.text().empty() ? elements[element.generic()]
                            : of_layer              ? layer_keys
                                                    : scene_keys;
        const std::string_view name = !element.text().empty() ? key.below(element)
                                      : of_layer              ? key.below("layer.stars")
                                                              : std::string_view(key.text());
        text += std::string(name) + " = " + to_toml(parameter.get()) + "\n";
    }
    std::string text = "astrosplat = 1\n" + scene_keys + "\n[[layer]]\n" + layer_keys;
    for (const auto& [header, keys] : elements) text += "\n[[" + header + "]]\n" + keys;
    return text;
}

}  // namespace astrosplat::test
