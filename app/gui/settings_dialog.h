// Edit > Settings: one row of choices for every setting of the window.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

/// Open while ViewState::settings_open. Every choice acts at once or says when it does; closing asks for them
/// to be kept (Command::keep_settings).
void draw_settings_dialog(GuiFrame& frame);

}  // namespace astrosplat
