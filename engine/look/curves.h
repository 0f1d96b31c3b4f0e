// The curves an artist drags: points in, monotone cubic out. Evaluated by look_curve in
// shaders/shared/look.glsl.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string>

#include "look/shared_uniforms.h"

namespace astrosplat {

/// Tangents after Fritsch and Carlson (Monotone Piecewise Cubic Interpolation, SIAM J. Numer. Anal. 17,
/// 1980): the curve passes through every point and never leaves the range of the two points around it. No
/// points: constant 1. Throws InputError, naming `key`, for more than 16 points or x that does not ascend.
LookCurve make_curve(std::span<const glm::vec2> points, const std::string& key);

}  // namespace astrosplat
