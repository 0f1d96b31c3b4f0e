// The built-in relief and sheet. In: a picture. Out: a mesh whose heights are its brightness, or another map.
#pragma once

#include "source/mesh.h"
#include "source/texture.h"

namespace astrosplat {

/// The built-in "relief": the plane of the texture's aspect, lifted towards +y by the smoothed brightness of
/// the picture; `height` is a fraction of the plane's width. 256 cells along the longer side.
Mesh relief_mesh(const Texture& texture, double height);

/// "sheet": the same plane, displaced along y by `shape.depth_map`, whose mean channel is the height as
/// stored, or without one by the picture's displayed brightness. Blurred, then stretched to `shape.depth` of
/// the width, half of it on either side. 512 cells along the longer side. Throws InputError where the map
/// cannot be read.
Mesh sheet_mesh(const Texture& texture, const ShapeParams& shape);

}  // namespace astrosplat
