// The five tabs. Each draws sections of rows for the parameters that matter as the scene stands.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

void source_tab(Context& context);
void look_tab(Context& context);
void render_tab(Context& context);
void camera_tab(Context& context);
void output_tab(Context& context);

/// The look's distance at which x = 1 for the selected layer, scene units; 0: not known.
double reach_of(const Context& context);

/// What can be done with a layer's look as a whole, as buttons or as items of a menu.
void look_buttons(Context& context);
void look_menu(Context& context);

}  // namespace astrosplat::panel
