// What a layer's pictures show from the front: its meshes drawn flat, without light or depth. In: meshes
// and the frame around them. Out: the picture that a front view of the layer's splats is to look like.
#pragma once

#include <span>

#include "core/image.h"
#include "core/progress.h"
#include "scene/front_frame.h"

namespace astrosplat {

/// Red, green and blue of linear light on black, as many pixels per scene unit as the pictures have on
/// average, so that one picture on a plane comes out as it is; black where no face is. Of faces behind each
/// other the nearest is seen. Throws InputError (no texture coordinates, larger than 65536 px), Cancelled.
Image front_picture(std::span<const TexturedMesh> meshes, const FrontFrame& frame,
                    const Progress& progress = {});

}  // namespace astrosplat
