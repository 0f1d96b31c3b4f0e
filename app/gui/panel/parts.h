// The parts of the side panel, each drawn at the cursor of the current ImGui window: the list of layers,
// tabs, and the row of one parameter with its widget, its plot and its words. All of a row follows from the
// parameter's description.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gui/panel/context.h"
#include "gui/panel/controls.h"

namespace astrosplat::panel {

/// Draws the row of a parameter.
void parameter_row(Context& context, const Parameter& parameter);

/// The places of a row's parts.
struct RowLayout {
    Rect whole, label, value;
    ImVec2 diamond;  // its middle
};

struct Row {
    const Parameter& parameter;
    Value value;  // at the current frame
    RowLayout layout;
    const ParameterKey& key() const { return parameter.spec.key; }
};

/// The value's widget by the parameter's type. True where it took more than one row's height, and the cursor
/// stands below it already.
bool value_field(Context& context, const Row& row);

/// A drawing above the row of this parameter; none for most.
void draw_above(Context& context, const ParameterSpec& spec);

/// The word shown in place of 0 where that is no amount, with the value in use where it is known: "Off",
/// "Auto (0.0165)". Empty: it is an amount.
std::string zero_in_words(const Context& context, const ParameterSpec& spec);

/// The names that a row of colour management offers besides the empty one; none: it is no such row, or they
/// are not known.
std::optional<std::vector<std::string>> names_to_choose(const Context& context, const ParameterSpec& spec);

/// The text of a row whose value is empty: "Screen (first)"; "None" for most.
std::string empty_in_words(const Context& context, const ParameterSpec& spec);

/// Whether there is anything to choose in a row of colour management; true for all others.
bool suits_colors(const Context& context, const ParameterSpec& spec);

/// At the head of the folded section of colour management: "Screen, Film".
std::string colors_state(const Context& context);

/// The tab `name`, as ParameterSpec::tab has it. Layers' tabs show the selected layer; there must be one.
void draw_tab(Context& context, std::string_view name);

/// The content of a section of a tab besides its parameters: the words at its head, which rows come first,
/// what follows the last. A section that is not listed has its rows alone.
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

/// Draws the list of layers over the width of the current window, `height` px at most; longer lists scroll.
void layer_list(Context& context, float height);

/// The plus that adds a layer, with its menu.
void add_layer_button(Context& context);

/// How far layer i is generated, or that it has to be, with the button that stops or begins it.
void load_line(Context& context, std::size_t i, float width, const std::string& loading,
               const std::string& stale);

/// Height the whole list would take, px.
float layer_list_height(const Context& context);

}  // namespace astrosplat::panel
