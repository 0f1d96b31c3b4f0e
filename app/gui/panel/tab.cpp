// Loops over the description: a parameter appears in the section that it names, in the order it was described
// in, where it has an effect. Lists of tables come from a table here; what else sections hold: parts.h.
#include "gui/panel/parts.h"

#include <fmt/format.h>

#include "core/text.h"
#include "edit/edits.h"

namespace astrosplat::panel {
namespace {

// Lists of tables within a layer (meshes, noises, thickness stops): their place in a tab, and how elements
// come and go.

struct ListRows {
    ParameterKey key;       // generic: "layer.look.noise"
    std::string section;    // that shows it
    ParameterKey after{};   // generic key of the row before it; "": it comes first
    const char* title;      // of an element, before its number
    const char* element;    // in the names of edits
    std::size_t least = 0;  // so many stay, and have no head while there are no more
    void (*add)(LayerParams&, const LayerStatus&) = nullptr;  // nullptr: as new ones are
    void (*added)(ViewState&, const LayerParams&) = nullptr;  // what the view does then
    bool (*can_grow)(const LayerParams&) = nullptr;           // nullptr: always
    bool (*is_shown)(const LayerParams&) = nullptr;           // likewise
    const char* inner = nullptr;                              // key of the alternatives in each element
    std::size_t (*size)(const LayerParams&) = nullptr;        // these two by list_of_tables()
    void (*remove)(LayerParams&, std::size_t index) = nullptr;
};

template <class T>
void erase_at(std::vector<T>& list, std::size_t index) {
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(index));
}

/// `list` finds it in a layer. What is added is as new elements are, unless `rows` says more.
template <auto list>
ListRows list_of_tables(ListRows rows) {
    rows.size = [](const LayerParams& layer) { return list(layer).size(); };
    rows.remove = [](LayerParams& layer, std::size_t index) { erase_at(list(layer), index); };
    if (!rows.add) rows.add = [](LayerParams& layer, const LayerStatus&) { list(layer).emplace_back(); };
    return rows;
}

constexpr auto meshes_of = [](auto& layer) -> auto& { return layer.source.meshes; };
constexpr auto masks_of = [](auto& layer) -> auto& { return layer.source.texture.mask; };
constexpr auto noises_of = [](auto& layer) -> auto& { return layer.look.noise; };
constexpr auto crops_of = [](auto& layer) -> auto& { return layer.look.crop; };
constexpr auto stops_of = [](auto& layer) -> auto& { return layer.look.thickness.stops; };

bool is_mesh(const LayerParams& layer) { return layer.source.kind == SourceKind::mesh; }

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

void add_mesh(LayerParams& layer, const LayerStatus&) { layer.source.meshes.push_back({"plane", {}, 0.15}); }

template <auto list, std::size_t most>
bool has_less_than(const LayerParams& layer) {
    return list(layer).size() < most;
}

/// Outlines are drawn in the view.
bool can_take_crop(const LayerParams& layer) {
    return std::ranges::count_if(layer.look.crop,
                                 [](const Crop& c) { return c.shape != Crop::Shape::outline; }) < 8;
}

const ListRows lists[] = {list_of_tables<meshes_of>({.key = "layer.source.meshes",
                                                     .section = "Files",
                                                     .after = "layer.source.kind",
                                                     .title = "Mesh",
                                                     .element = "mesh",
                                                     .least = 1,
                                                     .add = add_mesh,
                                                     .is_shown = is_mesh}),
                          list_of_tables<masks_of>({.key = "layer.source.mask",
                                                    .section = "Masks",
                                                    .after = "layer.source.detail",
                                                    .title = "Mask",
                                                    .element = "mask",
                                                    .is_shown = is_mesh,
                                                    .inner = "any"}),
                          list_of_tables<noises_of>({.key = "layer.look.noise",
                                                     .section = "Noise",
                                                     .title = "Noise",
                                                     .element = "noise",
                                                     .can_grow = has_less_than<noises_of, 4>}),
                          list_of_tables<crops_of>({.key = "layer.look.crop",
                                                    .section = "Crop",
                                                    .title = "Crop",
                                                    .element = "crop",
                                                    .add = add_crop,
                                                    .added = handle_last_crop,
                                                    .can_grow = can_take_crop}),
                          list_of_tables<stops_of>({.key = "layer.look.thickness.keys",
                                                    .section = "Thickness map",
                                                    .after = "layer.look.thickness.map",
                                                    .title = "Stop",
                                                    .element = "thickness stop",
                                                    .add = add_thickness_stop,
                                                    .can_grow = can_take_thickness_stop})};

/// Whether a section shows a list.
bool has_list(std::string_view section) {
    return std::ranges::any_of(lists, [&](const ListRows& list) { return list.section == section; });
}

bool is_in_list(const ParameterSpec& spec) {
    return std::ranges::any_of(lists,
                               [&](const ListRows& list) { return spec.generic_key.is_below(list.key); });
}

/// The line above an element; true when its cross was clicked.
bool numbered_head(const char* title, std::size_t index) {
    return element_head(fmt::format("{} {}", title, index).c_str());
}

/// "Add mesh", of the selected layer.
void edit_list(Context& context, const char* verb, const char* element,
               const std::function<void(LayerParams&)>& change) {
    edit(context, context.layer_key(), fmt::format("{} {}", verb, element),
         [&](Scene& scene) { change(scene.layers[context.view.layer]); });
}

/// The line below the last element that adds another.
void list_add_line(Context& context, const ListRows& list) {
    const bool full = list.can_grow && !list.can_grow(context.layer());
    if (full || !add_line(("Add " + lower_case(list.title)).c_str())) return;
    edit_list(context, "Add", list.element,
              [&](LayerParams& layer) { list.add(layer, context.layer_status()); });
    if (list.added) list.added(context.view, context.document.scene().layers[context.view.layer]);
}

using Rows = std::vector<const Parameter*>;

Rows rows_of_tab(const Context& context, std::string_view tab) {
    const ParameterKey layer = context.layer_key();
    Rows rows;
    for (const Parameter& parameter : context.memory.described.description.parameters) {
        const ParameterKey& key = parameter.spec.key;
        if (parameter.spec.tab == tab && (!key.is_below("layer") || key.is_below(layer)))
            rows.push_back(&parameter);
    }
    return rows;
}

void draw_row(Context& context, const Parameter& parameter) {
    draw_above(context, parameter.spec);
    parameter_row(context, parameter);
}

void draw_rows_below(Context& context, const ParameterKey& element, const Rows& tab_rows,
                     const ParameterKey& left_out) {
    for (const Parameter* row : tab_rows)
        if (row->spec.key.is_below(element) && !(!left_out.empty() && row->spec.key.is_below(left_out)) &&
            is_shown(context, row->spec))
            draw_row(context, *row);
}

/// The alternatives of mask i, a list within the list.
void draw_alternatives(Context& context, const ParameterKey& list, std::size_t i, const Rows& tab_rows) {
    for (std::size_t k = 0; k < masks_of(context.layer())[i].any.size(); ++k) {
        ImGui::PushID(static_cast<int>(k));
        const bool removed = numbered_head("Or", k);
        draw_rows_below(context, list / k, tab_rows, {});
        ImGui::PopID();
        if (removed)
            edit_list(context, "Remove", "alternative",
                      [&](LayerParams& layer) { erase_at(masks_of(layer)[i].any, k); });
    }
    if (add_line("Add alternative"))
        edit_list(context, "Add", "alternative",
                  [&](LayerParams& layer) { masks_of(layer)[i].any.emplace_back(); });
}

void draw_list(Context& context, const ListRows& list, const Rows& tab_rows) {
    for (std::size_t i = 0; i < list.size(context.layer()); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const bool removed = list.size(context.layer()) > list.least && numbered_head(list.title, i);
        const ParameterKey element = list.key.moved("layer", context.layer_key()) / i;
        const ParameterKey alternatives = list.inner ? element / list.inner : ParameterKey();
        draw_rows_below(context, element, tab_rows, alternatives);
        if (list.inner) draw_alternatives(context, alternatives, i, tab_rows);
        ImGui::PopID();
        if (removed)
            edit_list(context, "Remove", list.element, [&](LayerParams& layer) { list.remove(layer, i); });
    }
    list_add_line(context, list);
}

/// Those that belong after the row of a generic key, or with "" at the section's beginning.
void draw_lists(Context& context, const TabSection& about, const ParameterKey& after, const Rows& tab_rows) {
    for (const ListRows& list : lists)
        if (list.section == about.title && list.after == after &&
            (!list.is_shown || list.is_shown(context.layer())))
            draw_list(context, list, tab_rows);
}

void draw_section(Context& context, const TabSection& about, Rows rows, const Rows& tab_rows) {
    if (!section(context, head_of(context, about), about.state ? about.state(context) : "",
                 about.is_open && about.is_open(context)))
        return;
    const auto rank = [&](const Parameter* row) { return rank_in(about, row->spec); };
    std::ranges::stable_sort(rows, {}, rank);
    draw_lists(context, about, "", tab_rows);
    for (const Parameter* row : rows) {
        draw_row(context, *row);
        draw_lists(context, about, row->spec.generic_key, tab_rows);
    }
    if (about.last) about.last(context);
}

/// A section whose rows all have no effect is not there.
void draw_section(Context& context, const TabSection& about, const Rows& tab_rows) {
    if (about.is_there && !about.is_there(context)) return;
    Rows rows;
    for (const Parameter* row : tab_rows)
        if (row->spec.section == about.title && !is_in_list(row->spec) && is_shown(context, row->spec))
            rows.push_back(row);
    if (!rows.empty() || has_list(about.title) || about.last)
        draw_section(context, about, std::move(rows), tab_rows);
}

}  // namespace

bool is_shown(const Context& context, const ParameterSpec& spec) {
    const auto find_by_key = [&](const ParameterKey& key) { return find(context, key); };
    return has_effect(spec, find_by_key) && suits_layer(context, spec);
}

void draw_tab(Context& context, std::string_view name) {
    const Rows rows = rows_of_tab(context, name);
    std::vector<TabSection> sections;
    for (const TabSection& section : tab_sections())
        if (section.tab == name) sections.push_back(section);
    for (const Parameter* row : rows) {
        const auto is_its = [&](const TabSection& s) { return s.title == row->spec.section; };
        if (std::none_of(sections.begin(), sections.end(), is_its))
            sections.push_back({name, std::string(row->spec.section)});
    }
    std::ranges::stable_sort(sections, {}, [&](const TabSection& s) { return order_of(context, s); });
    for (const TabSection& section : sections) draw_section(context, section, rows);
}

}  // namespace astrosplat::panel
