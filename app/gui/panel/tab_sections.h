// The content of a section of a tab besides its parameters: the words at its head, which rows come first,
// what follows the last. A section that is not listed here has its rows alone.
#pragma once

#include <span>

#include "gui/panel/context.h"

namespace astrosplat::panel {

struct TabSection {
    std::string_view tab;
    std::string title;
    bool (*is_open)(const Context&) = nullptr;       // at first; nullptr: folded
    std::string (*state)(const Context&) = nullptr;  // at the head while it is folded
    std::vector<ParameterKey> first = {};            // generic keys or groups; the others follow as described
    void (*last)(Context&) = nullptr;                // below the rows
    bool (*is_there)(const Context&) = nullptr;      // nullptr: always
};

/// In the order of the tabs.
std::span<const TabSection> tab_sections();

/// The place of a row in its section: smaller ones come first, equal ones as described.
std::size_t rank_in(const TabSection& section, const ParameterSpec& spec);

/// Whether a parameter makes sense for the selected layer and the view, where that takes more than other
/// parameters' values to say (ParameterSpec::conditions): those of FITS files, a density that stops replace,
/// and references of other views.
bool suits_layer(const Context& context, const ParameterSpec& spec);

// At the end of sections (section_ends.cpp).

/// The two pictures with a line between them to drag, what was done, a button.
void draw_preparation(Context& context);
void placement_buttons(Context& context);
void crop_buttons(Context& context);
void reference_buttons(Context& context);
/// Below the rows of colour management: why the configuration cannot be used.
void colors_note(Context& context);
/// Commands on a layer's look as a whole, as buttons or as items of a menu.
void look_buttons(Context& context);
void look_menu(Context& context);

// At the top of tabs.
void source_state(Context& context);
void camera_buttons(Context& context);
void output_buttons(Context& context);

}  // namespace astrosplat::panel
