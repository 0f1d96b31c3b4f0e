// The sheet of shortcuts (F1) and the log: two dialogs that only show.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

void draw_shortcut_sheet(GuiFrame& frame);
void draw_log(GuiFrame& frame);

}  // namespace astrosplat
