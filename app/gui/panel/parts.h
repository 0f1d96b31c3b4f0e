// The parts of the side panel, each drawn at the cursor of the current ImGui window: the list of layers,
// tabs, and the row of one parameter with its widget, its plot and its words. All of a row follows from the
// parameter's description.
#pragma once

#include <optional>
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
