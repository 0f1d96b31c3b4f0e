// A tab of the panel: the described parameters of its name, section by section.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// `name` as ParameterSpec::tab has it. Layers' tabs show the selected layer; there must be one.
void draw_tab(Context& context, std::string_view name);

}  // namespace astrosplat::panel
