// The choice of frames to render to files, their size and place: a dialog that edits ViewState::render.
#pragma once

#include "gui/gui_frame.h"

namespace astrosplat {

/// Opens it with what the scene says.
void open_render_dialog(const Document& document, ViewState& view, RenderKind kind);

void draw_render_dialog(GuiFrame& frame);
}  // namespace astrosplat
