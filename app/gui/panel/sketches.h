// Small sketches of what parameters mean: a dot, the angles of a hybrid, a noise.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// The dot of a falloff and, beside it, its profile.
void draw_falloff(const Falloff& falloff);
/// The angles at which a hybrid changes from over to screen, as sectors between face-on and edge-on.
void draw_hybrid(float from_deg, float to_deg);
/// The field of a noise over `span` scene units of the plane across y; computed when it changes.
void draw_noise(Context& context, std::size_t entry, const Noise& noise, double span);

}  // namespace astrosplat::panel
