// The built-in shapes beyond plane, disk and sphere, and the relief and sheet that a picture's brightness or
// another map raises. In: a name and the shape's own measures; a picture. Out: a mesh about the origin, 10
// scene units across or along, normals outward, with texture coordinates.
#pragma once

#include <string>

#include "source/mesh.h"
#include "source/texture.h"

namespace astrosplat {

/// "revolution": the outline of `shape`, from its lower end, v by its length, straight between its points.
/// "hourglass": two closed lobes along y with r = width (waist sin t + (1 - waist) |sin 2t|), y = -5 cos t.
/// "shell": the walls of a hollow ball, radius 5 and 5 (1 - thickness); the inner one looks inward.
/// "bubble": a sphere that is open around +y, up to `opening` degrees from it; v as on the whole sphere.
/// "spheroid": spheres flattened along y, nested at radii whose number per length falls as
/// e^(-concentration r / 5); the outermost has radius 5.
/// "ring": a torus about y, 5 to its outer rim; v around its tube from the inner side.
/// Throws InputError for an outline of fewer than two points.
Mesh turned_shape(const std::string& name, const ShapeParams& shape);
bool is_turned_shape(const std::string& name);

/// The built-in "relief": the plane of the texture's aspect, lifted towards +y by the smoothed brightness of
/// the picture; `height` is a fraction of the plane's width. 256 cells along the longer side.
Mesh relief_mesh(const Texture& texture, double height);

/// "sheet": the same plane, displaced along y by `shape.depth_map`, whose mean channel is the height as
/// stored, or without one by the picture's displayed brightness. Blurred, then stretched to `shape.depth` of
/// the width, half of it on either side. 512 cells along the longer side. Throws InputError where the map
/// cannot be read.
Mesh sheet_mesh(const Texture& texture, const ShapeParams& shape);

}  // namespace astrosplat
