// Rotations: quaternions x y z w, matrices of orthonormal columns, and degrees as scenes say them, with the
// engine's own trigonometry.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace astrosplat {

/// Of a quaternion of length 1.
glm::dmat3 matrix_of_quaternion(const glm::dvec4& q);

/// Of a matrix that turns and does not mirror; length 1, w >= 0.
glm::dvec4 quaternion_of_matrix(const glm::dmat3& m);

/// Turns by b, then by a.
glm::dvec4 quaternion_product(const glm::dvec4& a, const glm::dvec4& b);

/// From a (t = 0) to b (1), both of length 1, the short way round at even speed.
glm::dvec4 quaternion_between(const glm::dvec4& a, glm::dvec4 b, double t);

/// Rotation about x, then y, then z.
glm::dmat3 rotation_from_degrees(const glm::dvec3& degrees);

/// The same turn from -180 up to 180 degrees.
inline double within_half_turn(double degrees) {
    return degrees - 360.0 * std::floor((degrees + 180.0) / 360.0);
}

}  // namespace astrosplat
