// Where the picture of a plane-like layer lies in the world, and the cameras that judge it. In: the layer's
// meshes. Out: a rectangle, and cameras that see it from the front, from 60 degrees and from its edge.
#pragma once

#include <optional>
#include <span>

#include "camera/camera.h"
#include "render/frame.h"
#include "source/textured_mesh.h"

namespace astrosplat {

/// The directions are those of somebody who looks at the picture, unit and right-handed.
struct FrontFrame {
    glm::dvec3 center{0.0};
    glm::dvec3 right{1.0, 0.0, 0.0}, up{0.0, 0.0, -1.0}, toward{0.0, 1.0, 0.0};  // toward: to the viewer
    double width = 10.0, height = 10.0;                                          // scene units
    /// uv = "camera": that the front is seen through; height is then the width over its picture's aspect.
    std::optional<Camera> camera;
};

/// The meshes' box along its thinnest axis (y where it is none), turned so that the pictures read right. In
/// the meshes' own space. With the camera of the first mesh, if it has one. The meshes have an extent, else
/// InputError.
FrontFrame front_frame(std::span<const TexturedMesh> meshes);

/// The same in the world, as the layer's transform has it.
FrontFrame in_world(const FrontFrame& frame, const RenderLayer& layer);

enum class JudgingView { front, side, edge };

/// Orthographic cameras, but for the front of a frame that has its own: `front` shows the frame's width
/// exactly, and as much of its height as a picture of this aspect (width / height) shows; `side` stands 60
/// degrees away from the frame's normal, which is up, `edge` in its plane, and both show its width.
CameraParams judging_camera(const FrontFrame& frame, JudgingView view, double aspect);

}  // namespace astrosplat
