// What the widgets are told: layers, picture, machine, the pixel under the mouse.
#pragma once

#include "viewer/session_state.h"

namespace astrosplat {

/// Fills Status but for what commands, jobs and the disk say.
void fill_status(SessionState& state);

/// Fills Status::probe with the linear pixel under the mouse, px of the viewport.
void probe(SessionState& state, glm::dvec2 mouse_px);

}  // namespace astrosplat
