// Interpolation of keyframes over frames (DESIGN 6): linear, smooth, step and Bezier scalars, centripetal
// Catmull-Rom and Bezier positions (optionally at constant speed), slerped rotations. A value at frame k is a
// function of the keyframes and k alone.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "camera/keyframe.h"

namespace astrosplat {

// Keyframes are ascending in frame, at least one; before the first and after the last the value is held.
// Ends::ease: a smooth track starts and ends at rest; through: with one-sided tangents.

/// Smooth: cubic Hermite with tangent (v[i+1]-v[i-1])/(t[i+1]-t[i-1]), clamped to the range of the segment's
/// two keyframes. Bezier: the curve of frame and value through both handles.
double evaluate_scalar(std::span<const Keyframe<double>> keyframes, double frame, Ends ends);

/// Smooth: a centripetal Catmull-Rom curve (one-sided at the ends and where two keyframes coincide), run
/// through with a speed that is continuous at the keyframes. `constant_speed`: the length covered since the
/// first keyframe grows evenly with the frame, whatever the frames of the keyframes between; with Ends::ease
/// a smooth path gathers its speed over the first tenth of the time and loses it over the last. Step segments
/// are jumps without length then. Bezier: the handles are control points in space, their frames the timing.
glm::dvec3 evaluate_position(std::span<const Keyframe<glm::dvec3>> keyframes, double frame, Ends ends,
                             bool constant_speed);

/// Quaternions x y z w of any length above 0; the result has length 1. Slerp the shorter way; smooth: with an
/// angular speed that is continuous at the keyframes; Bezier is taken for smooth.
glm::dvec4 evaluate_rotation(std::span<const Keyframe<glm::dvec4>> keyframes, double frame, Ends ends);

}  // namespace astrosplat
