// The falloffs as C++ sees them: w(t) from shaders/shared/falloff.glsl and its integral over the unit disc.
#pragma once

#include "render/layer_render.h"

namespace astrosplat {

/// w(t), t >= 0.
double falloff_value(const Falloff& falloff, double t);

/// Integral of w(|p|) over the unit disc: the flux of a splat of radius 1 px and alpha 1, square px.
double falloff_integral(const Falloff& falloff);

/// Its variance along an axis, square radii.
double falloff_variance(const Falloff& falloff);

}  // namespace astrosplat
