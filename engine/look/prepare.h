// From the look's keys to the numbers its arithmetic needs: curves become knots, defaults are resolved,
// matching becomes a factor per thickness stop. Costs microseconds, so animation and sliders may call it
// every frame. Curves are the points an artist drags in, as a monotone cubic, evaluated by look_curve in
// shaders/shared/look.glsl; matching needs the light of a front view through a layer with such profiles: the
// integrals of DESIGN 5, step 5.
#pragma once

#include <glm/vec2.hpp>

#include "look/apply.h"
#include "look/shared_uniforms.h"

namespace astrosplat {

/// Throws InputError as apply_look does. Warns where colours would be divided by alpha twice.
PreparedLook prepare_look(const SplatSet& set, const Look& look, const LookInputs& inputs);

/// Share of a splat's alpha that the outlines leave at a place of the layer: LookInput::outlined.
float outlined(const PreparedLook& look, const glm::vec3& place);

/// Of the steps alone, for the curves an artist looks at. `key` begins the messages of make_curve.
LookProfile density_profile(const DensityCurve& pdf, const std::string& key);
LookProfile vertical_profile(const VerticalAlpha& vertical);
LookAlpha horizontal_step(const HorizontalAlpha& alpha);

/// Tangents after Fritsch and Carlson (Monotone Piecewise Cubic Interpolation, SIAM J. Numer. Anal. 17,
/// 1980): the curve passes through every point and never leaves the range of the two points around it. No
/// points: constant 1. Throws InputError, naming `key`, for more than 16 points or x that does not ascend.
LookCurve make_curve(std::span<const glm::vec2> points, const std::string& key);

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
