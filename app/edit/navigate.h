// Navigation as pure functions on FreeCamera. In: a camera and what the hand did. Out: the camera after it.
// Pixels are the viewport's, y down; angles are so that what is under the mouse follows it.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "edit/view_state.h"

namespace astrosplat {

/// Scene units a pixel covers in the plane through the pivot.
double scene_units_per_px(const FreeCamera& camera, double viewport_height_px);
/// The point of the plane through the pivot that lies under a pixel.
glm::dvec3 point_under(const FreeCamera& camera, const glm::dvec2& px, const glm::dvec2& viewport_px);
/// The point under a pixel at a depth along the line of sight (RenderedFrame's Z).
glm::dvec3 point_at_depth(const FreeCamera& camera, const glm::dvec2& px, const glm::dvec2& viewport_px,
                          double depth);

/// Around the pivot like a turntable: half a turn per viewport height, never over the poles.
FreeCamera orbit(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Sideways, so that the plane through the pivot moves with the mouse.
FreeCamera pan(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Towards the pivot (dragging up or right): a viewport height is a factor of 16 in distance.
FreeCamera dolly(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Nearer by a factor of 1.15 a step; the point of the pivot's plane under the mouse stays there.
FreeCamera zoom_to(const FreeCamera& camera, double steps, const glm::dvec2& px,
                   const glm::dvec2& viewport_px);
/// Turns the camera where it stands, one field of view per viewport height.
FreeCamera look_around(const FreeCamera& camera, const glm::dvec2& delta_px, double viewport_height_px);
/// Moves camera and pivot by scene units to the right, up and forward.
FreeCamera fly(const FreeCamera& camera, const glm::dvec3& distance);
/// Moves sideways until `point` is in the middle; it is the pivot then. A point behind the camera is not
/// taken.
FreeCamera with_pivot(const FreeCamera& camera, const glm::dvec3& point);

}  // namespace astrosplat
