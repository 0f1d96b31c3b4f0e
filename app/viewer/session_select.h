// A click in the picture selects the layer that is seen there.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Selects the layer with the most light at a place of the viewport, px; `behind`: of the others there, the
/// next one after the selected layer. Shows its box and says which one of how many it is. Where no layer
/// is seen the box goes.
void select_layer_at(Session& session, glm::dvec2 mouse_px, bool behind);

}  // namespace astrosplat
