// Interpolation of keys over frames (DESIGN 6): linear, smooth and step scalars, centripetal Catmull-Rom positions
// (optionally at constant speed), slerped rotations. A value at frame k is a function of the keys and k alone.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace astrosplat {

enum class Interpolation { linear, smooth, step };
enum class Ends { ease, through };

template <class T>
struct Key {
    double frame;
    T value;
    Interpolation interpolation;  // the way to the next key
    bool operator==(const Key&) const = default;
};

/// Keys ascending in frame, at least one; before the first and after the last the value is held. Ends::ease: tangent
/// 0 at the first and last key of a smooth track; through: one-sided tangents.
double evaluate_scalar(std::span<const Key<double>> keys, double frame, Ends ends);
glm::dvec3 evaluate_position(std::span<const Key<glm::dvec3>> keys, double frame, Ends ends, bool constant_speed);
glm::dvec4 evaluate_rotation(std::span<const Key<glm::dvec4>> keys, double frame, Ends ends);  // unit quaternions

}  // namespace astrosplat
