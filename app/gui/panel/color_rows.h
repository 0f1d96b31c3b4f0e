// The rows of colour management: what a configuration has to choose from, and what its empty names stand for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// The names that a row offers besides the empty one; none: it is no such row, or they are not known.
std::optional<std::vector<std::string>> names_to_choose(const Context& context, const ParameterSpec& spec);

/// What a row shows where its text is empty: "Screen (first)"; "None" for most.
std::string empty_in_words(const Context& context, const ParameterSpec& spec);

/// Whether there is anything to choose in a row of colour management; true for all others.
bool suits_colors(const Context& context, const ParameterSpec& spec);

/// Beside the folded section: "Screen, Film".
std::string colors_state(const Context& context);

/// Below the rows: why the configuration cannot be used.
void colors_note(Context& context);

}  // namespace astrosplat::panel
