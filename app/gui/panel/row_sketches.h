// Plots that stand above the rows of some parameters and show what they mean, and what their zeros mean.
#pragma once

#include <string>

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// What belongs above the row of this parameter; nothing for most.
void draw_above(Context& context, const ParameterSpec& spec);

/// What is shown in place of 0 where that is no amount, with the value in use where it is known: "Off",
/// "Auto (0.0165)". Empty: it is an amount.
std::string zero_in_words(const Context& context, const ParameterSpec& spec);

}  // namespace astrosplat::panel
