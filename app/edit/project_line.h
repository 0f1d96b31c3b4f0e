// Points and lines of the world as they lie in a frame. In: a camera. Out: px of its frame, y down.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "camera/camera.h"

namespace astrosplat {

/// The camera of a frame that is shown `scale` times as large with its upper left at `corner`, px: what it
/// projects are px of where it is shown.
Camera camera_on_screen(const Camera& camera, const glm::dvec2& corner, double scale);

/// Along the view axis, scene units; below 0 behind the eye.
double view_depth(const Camera& camera, const glm::dvec3& point);

/// None where the point does not lie in front of the eye.
std::optional<glm::vec2> project_point(const Camera& camera, const glm::dvec3& point);

/// A line of several points, cut where it passes behind the eye.
std::vector<std::vector<glm::vec2>> project_line(const Camera& camera, const std::vector<glm::dvec3>& line);

/// The ray through a pixel: from the eye, or where rays are parallel from the plane through it.
struct ViewRay {
    glm::dvec3 origin, direction;  // of length 1
};
ViewRay ray_through(const Camera& camera, const glm::dvec2& px);

/// Scene units that a pixel covers at a point.
double units_per_px(const Camera& camera, const glm::dvec3& point);

}  // namespace astrosplat
