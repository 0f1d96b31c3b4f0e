// The camera that took a picture, for projecting it back onto what stands before it (uv = "camera"). In: what
// the scene says of it. Out: where points are seen in the picture.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "camera/camera.h"
#include "source/mesh.h"
#include "source/source.h"

namespace astrosplat {

/// As one that takes a picture `aspect` px wide and 1 px high. `params` has a position and is not degenerate.
Camera picture_camera(const UvCamera& params, double aspect);

/// The same as parameters, for rendering what it saw.
CameraParams params_of(const Camera& camera);

struct PlaceInPicture {
    glm::dvec2 uv;  // v = 0 is the bottom row; 0..1 within the picture
    double depth;   // scene units before the eye, along the view axis
};
/// Where the picture shows a point; empty for what is not before the eye.
std::optional<PlaceInPicture> place_in_picture(const Camera& camera, const glm::dvec3& point);

/// Scene units from the picture's bottom to its top at a depth.
double picture_height_at(const Camera& camera, double depth);

/// The camera of a picture that is so many times as wide and high, with what this one sees in its middle.
Camera widened(Camera camera, glm::dvec2 times);

/// Gives every vertex the place where the picture shows it, and none to faces not wholly before the eye.
void apply_camera_uv(Mesh& mesh, const Camera& camera);

}  // namespace astrosplat
