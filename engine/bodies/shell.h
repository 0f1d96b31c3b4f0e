// How far the two walls of a shell stand apart. In: the picture's light without its stars. Out: a field like
// those of fields.h, half of the distance between the walls, in texels.
#pragma once

#include <vector>

#include "core/image.h"
#include "image/area.h"

namespace astrosplat {

/// The light of wide areas, coarse enough to solve equations on.
struct SilhouetteGrid {
    Image light;
    std::vector<ImageSize> finer;  // from that of the fields on down, each half the one before
};
SilhouetteGrid silhouette_grid(const Image& brightest);

/// 1 where light is above a twelfth of its range, 0 where it is below, with a soft edge.
Image silhouette_of(Image light);

/// What was found on the grid, at the size of the fields.
Image to_field_size(Image coarse, const SilhouetteGrid& grid);

/// h with -laplace(h) = 1 inside of a silhouette (1 there, 0 outside, soft between), a pixel as unit: r^2 / 4
/// in the middle of a disk.
Image blown_up(const Image& silhouette);

/// The picture's silhouette blown up like a balloon: h solves the Poisson equation -laplace(h) = 1 inside of
/// it and is 0 outside, and its root is an ellipsoid's height over an ellipse, a ridge's over a filament. At
/// most `depth`, at the middle of the widest part; nowhere steeper than `steepest`, for what is steeper looks
/// like drapery. The silhouette is where the light of wide areas is above a twelfth of its range.
Image shell_field(const Image& brightest, double depth, double steepest);

}  // namespace astrosplat
