// What a front view through a layer adds up to: the integrals behind `match` (DESIGN 5, step 5), which become
// one number per thickness stop.
#pragma once

#include "look/shared_uniforms.h"

namespace astrosplat {

/// Profiles and lengths of one column, on one side of the surface.
struct ColumnProfile {
    LookProfile pdf;              // p(x)
    LookProfile vertical;         // f(x)
    double density = 1.0;         // positions kept: min(1, density * p(x))
    double end = 1.0;             // x up to which there are positions, 0..1
    double vertical_ratio = 1.0;  // f is read at x * this
};

/// Integral over x in [0, end] of min(1, density p(x)) f(x vertical_ratio) lerp(1, vertical_scale, x)^2.
double column_integral(const ColumnProfile& column, double vertical_scale);

/// Mean of the square of a radius uniform in [min, max].
double mean_square(double min, double max);

}  // namespace astrosplat
