#include "core/rotation.h"

#include "core/real.h"

namespace astrosplat {

glm::dmat3 rotation_from_degrees(const glm::dvec3& degrees) {
    const double cx = real::cos(real::radians(degrees.x)), sx = real::sin(real::radians(degrees.x));
    const double cy = real::cos(real::radians(degrees.y)), sy = real::sin(real::radians(degrees.y));
    const double cz = real::cos(real::radians(degrees.z)), sz = real::sin(real::radians(degrees.z));
    const glm::dmat3 about_x(1.0, 0.0, 0.0, 0.0, cx, sx, 0.0, -sx, cx);
    const glm::dmat3 about_y(cy, 0.0, -sy, 0.0, 1.0, 0.0, sy, 0.0, cy);
    const glm::dmat3 about_z(cz, sz, 0.0, -sz, cz, 0.0, 0.0, 0.0, 1.0);
    return about_z * about_y * about_x;
}

}  // namespace astrosplat
