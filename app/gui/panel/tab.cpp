// Loops over the description: a parameter appears in the section that it names, in the order it was described
// in, where it has an effect. What sections show besides is in tab_sections.h, list_rows.h and
// row_sketches.h.
#include "gui/panel/tab.h"

#include <algorithm>

#include "gui/panel/list_rows.h"
#include "gui/panel/row.h"
#include "gui/panel/row_sketches.h"
#include "gui/panel/section.h"
#include "gui/panel/tab_sections.h"

namespace astrosplat::panel {
namespace {

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

bool is_shown(const Context& context, const ParameterSpec& spec) {
    const auto find_by_key = [&](const ParameterKey& key) { return find(context, key); };
    return has_effect(spec, find_by_key) && suits_layer(context, spec);
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

void draw_inner_list(Context& context, const InnerRows& list, const ParameterKey& element, std::size_t outer,
                     const Rows& tab_rows) {
    for (std::size_t i = 0; i < list.size(context.layer(), outer); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const bool removed = inner_element_head(list, i);
        draw_rows_below(context, element / list.key / i, tab_rows, {});
        ImGui::PopID();
        if (removed) remove_inner_element(context, list, outer, i);
    }
    inner_add_line(context, list, outer);
}

void draw_list(Context& context, const ListRows& list, const Rows& tab_rows) {
    for (std::size_t i = 0; i < list.size(context.layer()); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const bool removed = list_element_head(context, list, i);
        const ParameterKey element = list.key.moved("layer", context.layer_key()) / i;
        draw_rows_below(context, element, tab_rows, list.inner ? element / list.inner->key : ParameterKey());
        if (list.inner) draw_inner_list(context, *list.inner, element, i, tab_rows);
        ImGui::PopID();
        if (removed) remove_element(context, list, i);
    }
    list_add_line(context, list);
}

/// Those that belong after the row of a generic key, or with "" at the section's beginning.
void draw_lists(Context& context, const TabSection& about, const ParameterKey& after, const Rows& tab_rows) {
    for (const ListRows& list : list_rows())
        if (list.section == about.title && list.after == after &&
            (!list.is_shown || list.is_shown(context.layer())))
            draw_list(context, list, tab_rows);
}

void draw_section(Context& context, const TabSection& about, Rows rows, const Rows& tab_rows) {
    if (!section(context, about.title.c_str(), about.state ? about.state(context) : "",
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
        if (row->spec.section == about.title && !list_of(row->spec) && is_shown(context, row->spec))
            rows.push_back(row);
    if (!rows.empty() || has_list(about.title) || about.last)
        draw_section(context, about, std::move(rows), tab_rows);
}

}  // namespace

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
    for (const TabSection& section : sections) draw_section(context, section, rows);
}

}  // namespace astrosplat::panel
