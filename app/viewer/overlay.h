// What a free view draws over the picture: the path of the scene's camera and its frustum. In: the scene, the
// frame, the camera one looks through. Out: lines in px of the picture.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "camera/camera.h"
#include "scene/scene.h"

namespace astrosplat {

/// Of a scene all that its camera's path depends on, to notice when that changes; the rest at its defaults.
Scene camera_part(const Scene& scene);

/// Places of the scene's camera over the frames of [output], at most 256 of them; one where it does not move.
std::vector<glm::dvec3> camera_path(const Scene& scene, const Bounds& box);

/// Edges of the pyramid that `camera` sees, out to `length` scene units: lines of the four corners, then the
/// frame with a mark above its upper side.
std::vector<std::vector<glm::dvec3>> frustum(const Camera& camera, double width_px, double height_px,
                                             double length);

/// A line in the world as lines in px of the picture, cut where it passes behind the eye.
std::vector<std::vector<glm::vec2>> project_line(const Camera& camera, const std::vector<glm::dvec3>& line);

}  // namespace astrosplat
