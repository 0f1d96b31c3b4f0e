// Lists of tables within a layer (meshes, noises, thickness stops): where a tab shows their elements, and how
// elements come and go.
#pragma once

#include <span>

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// A list within each element of a list.
struct InnerRows {
    const char* key;      // below the element
    const char* title;    // of an element, before its number
    const char* element;  // in the names of edits
    std::size_t (*size)(const LayerParams&, std::size_t outer);
    void (*add)(LayerParams&, std::size_t outer);
    void (*remove)(LayerParams&, std::size_t outer, std::size_t index);
};

struct ListRows {
    ParameterKey key;     // generic: "layer.look.noise"
    std::string section;  // that shows it
    ParameterKey after;   // generic key of the row before it; "": it comes first
    const char* title;    // of an element, before its number
    const char* element;  // in the names of edits
    std::size_t least;    // so many stay, and have no head while there are no more
    std::size_t (*size)(const LayerParams&);
    void (*add)(LayerParams&, const LayerStatus&);
    void (*remove)(LayerParams&, std::size_t index);
    void (*added)(ViewState&, const LayerParams&) = nullptr;  // what the view does then
    bool (*can_grow)(const LayerParams&) = nullptr;           // nullptr: always
    bool (*is_shown)(const LayerParams&) = nullptr;           // likewise
    const InnerRows* inner = nullptr;                         // nullptr: none
};

std::span<const ListRows> list_rows();
/// Whether a section shows a list.
bool has_list(std::string_view section);
/// The list whose element a parameter belongs to; nullptr: none.
const ListRows* list_of(const ParameterSpec& spec);

/// The line above an element; true when its cross was clicked.
bool list_element_head(Context& context, const ListRows& list, std::size_t index);
void remove_element(Context& context, const ListRows& list, std::size_t index);
/// The same for an inner list, in the element `outer`.
bool inner_element_head(const InnerRows& list, std::size_t index);
void remove_inner_element(Context& context, const InnerRows& list, std::size_t outer, std::size_t index);
void inner_add_line(Context& context, const InnerRows& list, std::size_t outer);
/// The line below the last element that adds another.
void list_add_line(Context& context, const ListRows& list);

}  // namespace astrosplat::panel
