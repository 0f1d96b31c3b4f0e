// Pictures of a plane-like layer as seen from the front, and the cameras that judge it. In: the layer's
// meshes. Out: the rectangle where the picture lies in the world; cameras that see it from the front, from 45
// and 60 degrees and from its edge; the meshes drawn flat, without light or depth, as a front view of the
// layer's splats is to look.
#pragma once

#include "camera/camera.h"
#include "core/image.h"
#include "core/progress.h"
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
/// the meshes' own space. With the camera of the first mesh, if it has one. The meshes have an extent,
/// else InputError.
FrontFrame front_frame(std::span<const TexturedMesh> meshes);

/// The same in the world, as the layer's transform has it.
FrontFrame in_world(const FrontFrame& frame, const RenderLayer& layer);

enum class JudgingView { front, above, tilted, side, edge };

/// The frame turned so that a galaxy's normal points to the viewer, about its middle: what its side and edge
/// views are seen from. As it is where the scene does not say how the galaxy lies.
FrontFrame along_galaxy(FrontFrame frame, const GalaxyParams& galaxy);

/// That, turned further about its normal so that the line of sight that the picture was taken along is
/// upright from above.
FrontFrame along_sight(FrontFrame frame, const GalaxyParams& galaxy);

/// Orthographic cameras, but for the front of a frame that has its own: `front` shows the frame's width
/// exactly, and as much of its height as a picture of this aspect (width / height) shows; `above` sees the
/// same with parallel rays, `tilted` from 45 degrees below; `side` stands 60 degrees away from the frame's
/// normal, which is up, `edge` in its plane, and all show its width.
CameraParams judging_camera(const FrontFrame& frame, JudgingView view, double aspect);

/// Red, green and blue of linear light on black, as many pixels per scene unit as the pictures have on
/// average, so that one picture on a plane comes out as it is; black where no face is. Of faces behind each
/// other the nearest is seen. Throws InputError (no texture coordinates, larger than 65536 px), Cancelled.
Image front_picture(std::span<const TexturedMesh> meshes, const FrontFrame& frame,
                    const Progress& progress = {});

}  // namespace astrosplat
