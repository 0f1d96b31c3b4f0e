// The falloffs as C++ sees them: w(t) from shaders/shared/falloff.glsl, and integrals over them.
//
// A new falloff: its name and parameters in layer_render.h, w(t) in falloff.glsl, and here the places where
// it is not smooth.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/quadrature.h"
#include "render/layer_render.h"

namespace astrosplat {

/// w(t), t >= 0.
double falloff_value(const Falloff& falloff, double t);

/// The t in (0, 1), ascending, at which w has a kink or a jump: quadrature is not to run across them.
std::vector<double> falloff_kinks(const Falloff& falloff);

/// Integral of f(t) from 0 to 1, where f is smooth within the panels `ends` but for the falloff's kinks.
/// Panels shrink towards where f is sharp: most falloffs have their light in the centre.
template <class F>
double integrate_falloff(const Falloff& falloff, std::span<const double> ends, const F& f) {
    const std::vector<double> kinks = falloff_kinks(falloff);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        double panel = 0.0, from = ends[i];
        for (const double kink : kinks)
            if (kink > from && kink < ends[i + 1]) {
                panel += integrate_panel(from, kink, f);
                from = kink;
            }
        sum += panel + integrate_panel(from, ends[i + 1], f);
    }
    return sum;
}

/// Integral of w(|p|) over the unit disc: the flux of a splat of radius 1 px and alpha 1, square px.
double falloff_integral(const Falloff& falloff);

/// Its variance along an axis, square radii.
double falloff_variance(const Falloff& falloff);

}  // namespace astrosplat
