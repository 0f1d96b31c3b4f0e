// What the widgets are told: layers, picture, machine, the pixel under the mouse.
#pragma once

#include <set>
#include <string>

#include "viewer/session.h"

namespace astrosplat {

/// Fills Status but for what commands, jobs and the disk say.
void fill_status(Session& session);

/// Says in the message line why the picture or a layer failed; `said` holds what was said of those that still
/// do.
void say_new_errors(Status& status, std::set<std::string>& said);

/// Fills Status::probe with the linear pixel under the mouse, px of the viewport.
void probe(Session& session, glm::dvec2 mouse_px);

}  // namespace astrosplat
