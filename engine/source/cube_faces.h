// The six faces of a cube around the eye, in the order +x -x +y -y +z -z, as pictures of them have it.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace astrosplat {

/// A cube face as seen from the origin: where it lies and what is to the right and up in its picture. +y and
/// -y are seen tilting the head from -z.
struct CubeAxes {
    glm::dvec3 forward, right, up;
};
inline const std::array<CubeAxes, 6> cube_axes = {{
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
    {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
}};

/// Unit direction of a place on a face, in sides of it from its upper left corner.
inline glm::dvec3 cube_direction(const CubeAxes& face, double x, double y) {
    return glm::normalize(face.forward + face.right * (2.0 * x - 1.0) + face.up * (1.0 - 2.0 * y));
}

}  // namespace astrosplat
