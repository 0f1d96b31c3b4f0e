// How far the two walls of a shell stand apart. In: the picture's light without its stars. Out: a field like
// those of fields.h, half of the distance between the walls, in texels.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// The picture's silhouette blown up like a balloon: h solves the Poisson equation -laplace(h) = 1 inside of
/// it and is 0 outside, and its root is an ellipsoid's height over an ellipse, a ridge's over a filament. At
/// most `depth`, at the middle of the widest part; nowhere steeper than `steepest`, for what is steeper looks
/// like drapery. The silhouette is where the light of wide areas is above a twelfth of its range.
Image shell_field(const Image& brightest, double depth, double steepest);

}  // namespace astrosplat
