#include "gui/panel/list_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "gui/panel/section.h"
#include "gui/panel/words.h"

namespace astrosplat::panel {
namespace {

template <class T>
void erase_at(std::vector<T>& list, std::size_t index) {
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(index));
}

/// The first stop changes nothing.
void add_thickness_stop(LayerParams& layer, const LayerStatus&) {
    Look& look = layer.look;
    ThicknessStop stop;
    if (look.thickness.stops.empty()) stop.pdf = look.pdf;
    look.thickness.stops.push_back(stop);
}

bool can_take_thickness_stop(const LayerParams& layer) {
    const Thickness& thickness = layer.look.thickness;
    return thickness.stops.empty() || (!thickness.map.empty() && thickness.stops.size() < 8);
}

/// A box around the whole layer: nothing is cut until it is moved or made smaller.
void add_crop(LayerParams& layer, const LayerStatus& status) {
    Crop crop;
    if (!status.box.empty()) {
        const glm::dvec3 size = glm::max(status.box.extent(), glm::dvec3(1e-3));
        for (int i = 0; i < 3; ++i) {
            crop.center[i] = static_cast<float>(rounded_to_step(status.box.center()[i], 1e-2 * size[i]));
            crop.size[i] = static_cast<float>(rounded_to_step(1.1 * size[i], 1e-2 * size[i]));
        }
    }
    layer.look.crop.push_back(crop);
}

/// It is there to be dragged.
void handle_last_crop(ViewState& view, const LayerParams& layer) {
    view.tool = HandleTool::scale;
    view.handle_target = HandleTarget::crop;
    view.handle_crop = layer.look.crop.size() - 1;
}

std::vector<MaskParams>& masks_of(LayerParams& layer) { return layer.source.texture.mask; }

const InnerRows mask_alternatives = {
    .key = "any",
    .title = "Or",
    .element = "alternative",
    .size = [](const LayerParams& layer, std::size_t i) { return layer.source.texture.mask[i].any.size(); },
    .add = [](LayerParams& layer, std::size_t i) { masks_of(layer)[i].any.emplace_back(); },
    .remove = [](LayerParams& layer, std::size_t i, std::size_t k) { erase_at(masks_of(layer)[i].any, k); }};

const ListRows lists[] = {
    {.key = "layer.source.meshes",
     .section = "Files",
     .after = "layer.source.kind",
     .title = "Mesh",
     .element = "mesh",
     .least = 1,
     .size = [](const LayerParams& layer) { return layer.source.meshes.size(); },
     .add =
         [](LayerParams& layer, const LayerStatus&) {
             layer.source.meshes.push_back({"plane", {}, 0.15});
         },
     .remove = [](LayerParams& layer, std::size_t i) { erase_at(layer.source.meshes, i); },
     .is_shown = [](const LayerParams& layer) { return layer.source.kind == SourceKind::mesh; }},
    {.key = "layer.source.mask",
     .section = "Masks",
     .after = "layer.source.detail",
     .title = "Mask",
     .element = "mask",
     .least = 0,
     .size = [](const LayerParams& layer) { return layer.source.texture.mask.size(); },
     .add = [](LayerParams& layer, const LayerStatus&) { masks_of(layer).emplace_back(); },
     .remove = [](LayerParams& layer, std::size_t i) { erase_at(masks_of(layer), i); },
     .is_shown = [](const LayerParams& layer) { return layer.source.kind == SourceKind::mesh; },
     .inner = &mask_alternatives},
    {.key = "layer.look.noise",
     .section = "Noise",
     .after = "",
     .title = "Noise",
     .element = "noise",
     .least = 0,
     .size = [](const LayerParams& layer) { return layer.look.noise.size(); },
     .add = [](LayerParams& layer, const LayerStatus&) { layer.look.noise.emplace_back(); },
     .remove = [](LayerParams& layer, std::size_t i) { erase_at(layer.look.noise, i); },
     .can_grow = [](const LayerParams& layer) { return layer.look.noise.size() < 4; }},
    {.key = "layer.look.crop",
     .section = "Crop",
     .after = "",
     .title = "Crop",
     .element = "crop",
     .least = 0,
     .size = [](const LayerParams& layer) { return layer.look.crop.size(); },
     .add = add_crop,
     .remove = [](LayerParams& layer, std::size_t i) { erase_at(layer.look.crop, i); },
     .added = handle_last_crop,
     .can_grow = [](const LayerParams& layer) { return layer.look.crop.size() < 8; }},
    {.key = "layer.look.thickness.keys",
     .section = "Thickness map",
     .after = "layer.look.thickness.map",
     .title = "Stop",
     .element = "thickness stop",
     .least = 0,
     .size = [](const LayerParams& layer) { return layer.look.thickness.stops.size(); },
     .add = add_thickness_stop,
     .remove = [](LayerParams& layer, std::size_t i) { erase_at(layer.look.thickness.stops, i); },
     .can_grow = can_take_thickness_stop}};

}  // namespace

std::span<const ListRows> list_rows() { return lists; }

bool has_list(std::string_view section) {
    return std::ranges::any_of(lists, [&](const ListRows& list) { return list.section == section; });
}

const ListRows* list_of(const ParameterSpec& spec) {
    const auto holds = [&](const ListRows& list) { return spec.generic_key.is_below(list.key); };
    const auto found = std::ranges::find_if(lists, holds);
    return found == std::end(lists) ? nullptr : found;
}

bool list_element_head(Context& context, const ListRows& list, std::size_t index) {
    if (list.size(context.layer()) <= list.least) return false;
    return element_head(fmt::format("{} {}", list.title, index).c_str());
}

bool inner_element_head(const InnerRows& list, std::size_t index) {
    return element_head(fmt::format("{} {}", list.title, index).c_str());
}

void remove_inner_element(Context& context, const InnerRows& list, std::size_t outer, std::size_t index) {
    const std::size_t layer = context.view.layer;
    edit(context, context.layer_key(), std::string("Remove ") + list.element,
         [&](Scene& scene) { list.remove(scene.layers[layer], outer, index); });
}

void inner_add_line(Context& context, const InnerRows& list, std::size_t outer) {
    if (!add_line((std::string("Add ") + list.element).c_str())) return;
    const std::size_t layer = context.view.layer;
    edit(context, context.layer_key(), std::string("Add ") + list.element,
         [&](Scene& scene) { list.add(scene.layers[layer], outer); });
}

void remove_element(Context& context, const ListRows& list, std::size_t index) {
    const std::size_t layer = context.view.layer;
    edit(context, context.layer_key(), std::string("Remove ") + list.element,
         [&](Scene& scene) { list.remove(scene.layers[layer], index); });
}

void list_add_line(Context& context, const ListRows& list) {
    const std::string label = std::string("Add ") + lower_case(list.title);
    const bool full = list.can_grow && !list.can_grow(context.layer());
    if (full || !add_line(label.c_str())) return;
    const std::size_t layer = context.view.layer;
    edit(context, context.layer_key(), std::string("Add ") + list.element,
         [&](Scene& scene) { list.add(scene.layers[layer], context.layer_status()); });
    if (list.added) list.added(context.view, context.document.scene().layers[layer]);
}

}  // namespace astrosplat::panel
