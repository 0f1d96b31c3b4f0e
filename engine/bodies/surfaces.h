// Surfaces that bodies lie on or between, besides the plane of a disk: a sheet over a relief, and the two
// walls of a shell. In: the picture's light without its stars; dots with their depths from the surface. Out:
// half of the distance between the walls, in texels, as a field like those of fields.h; the same dots on the
// surface.
#pragma once

#include <vector>

#include "bodies/placement.h"
#include "core/image.h"
#include "image/resample.h"

namespace astrosplat {

/// The light of wide areas, coarse enough to solve equations on.
struct SilhouetteGrid {
    Image light;
    std::vector<ImageSize> finer;  // from that of the fields on down, each half the one before
};
SilhouetteGrid silhouette_grid(const Image& brightest);

/// 1 where light is above a twelfth of its range, 0 where it is below, with a soft edge.
Image silhouette_of(Image light);

/// The result on the grid, at the size of the fields.
Image to_field_size(Image coarse, const SilhouetteGrid& grid);

/// h with -laplace(h) = 1 inside of a silhouette (1 there, 0 outside, soft between), a pixel as unit: r^2 / 4
/// in the middle of a disk.
Image blown_up(const Image& silhouette);

/// The picture's silhouette blown up like a balloon: h solves the Poisson equation -laplace(h) = 1 inside of
/// it and is 0 outside, and its root is an ellipsoid's height over an ellipse, a ridge's over a filament. At
/// most `depth`, at the middle of the widest part; nowhere steeper than `steepest`, for what is steeper looks
/// like drapery. The silhouette is where the light of wide areas is above a twelfth of its range.
Image shell_field(const Image& brightest, double depth, double steepest);

/// Lifts dots onto the relief of a sheet, where there is one. Under a round knot it is level, but not under a
/// piece of a filament, which would become a flight of steps.
void add_relief(const Placement& placement, PlacedBlock& block);

/// Puts dots onto one of two walls, front or back, and bends these. A filament stays on one wall for as long
/// as it can; what belongs to a knot is where its middle is. Light of a core or of the sky
/// is anywhere within its reach; `feature`: texels, of the band's.
void add_walls(const Placement& placement, double feature, PlacedBlock& block);

/// Depths between two walls. Glow fills what is there, or one would look through the holes of one wall into a
/// hollow. It gathers in clouds as a disk's light does: spread evenly in every column it would be curtains.
void fill_between_walls(const Placement& placement, double feature, PlacedBlock& block);

}  // namespace astrosplat
