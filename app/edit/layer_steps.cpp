#include "edit/layer_steps.h"

#include "edit/edits.h"
#include "edit/layers.h"

namespace astrosplat {
namespace {

const std::string& name_of(const Document& document, std::size_t index) {
    return document.scene().layers.at(index).name;
}

}  // namespace

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

}  // namespace astrosplat
