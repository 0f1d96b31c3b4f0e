// The built-in relief. In: a picture. Out: a mesh whose heights are its brightness.
#pragma once

#include "source/mesh.h"
#include "source/texture.h"

namespace astrosplat {

/// The built-in "relief": the plane of the texture's aspect, lifted towards +y by the smoothed brightness of
/// the picture; `height` is a fraction of the plane's width. 256 cells along the longer side.
Mesh relief_mesh(const Texture& texture, double height);

}  // namespace astrosplat
