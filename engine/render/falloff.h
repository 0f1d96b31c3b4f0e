// The falloffs as C++ sees them: w(t) from shaders/shared/falloff.glsl, what the renderer has to know of it
// besides, and integrals over it.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/real.h"
#include "render/layer_render.h"

namespace astrosplat {

/// w(t), t >= 0.
double falloff_value(const Falloff& falloff, double t);

/// Facts about w(t), by its shape.
struct FalloffTraits {
    bool flat_core = false;          // exactly 1 inside, as constant and trapezoid: only the edge is scaled
    float core = 0.0f;               // share of the radius that is flat
    float reach = 1.0f;              // share of the radius that carries more than 1e-5 of the peak
    bool linear_in_distance = true;  // false: w is smooth in t^2, and tables run over that
    bool steep_centre = false;       // quadrature takes small steps there
    std::vector<double> kinks =
        {};  // in (0, 1), ascending: there w has a kink or a jump, and quadrature a break
};
FalloffTraits traits_of(const Falloff& falloff);

/// Integral of f(t) from 0 to 1, where f is smooth within the panels `ends` but for the falloff's kinks.
/// Panels shrink towards where f is sharp: most falloffs have their light in the centre.
template <class F>
double integrate_falloff(const Falloff& falloff, std::span<const double> ends, const F& f) {
    const std::vector<double> kinks = traits_of(falloff).kinks;
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
