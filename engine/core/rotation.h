// Rotations as scenes say them, in degrees, with the engine's own trigonometry.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace astrosplat {

/// Rotation about x, then y, then z.
glm::dmat3 rotation_from_degrees(const glm::dvec3& degrees);

}  // namespace astrosplat
