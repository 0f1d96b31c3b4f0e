// What bodies lie on or between, beside the plane of a disk: a sheet over a relief, and the two walls of a
// shell. In: dots with their depths from the surface. Out: the same on it.
#pragma once

#include "bodies/placement.h"

namespace astrosplat {

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
