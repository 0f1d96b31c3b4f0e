// Footprints on the sphere, for projections onto it: each is round there, in px of the middle of the frame
// along the chords between directions. In: the lens and places on the frame. Out: directions, and footprints
// with the right light whatever the projection makes of their pixels.
#pragma once

#include "camera/lens.h"
#include "render/fold.h"
#include "render/footprint.h"

namespace astrosplat {

/// Sets planes.toward: of each pixel the direction through its middle, camera space, of length focal_px; far
/// away from everything where the frame shows nothing.
void set_directions(const Lens& lens, TilePlanes& planes);

/// The footprint of a splat whose place on the frame is (x_px, y_px), snapped to 1/256 px; its radius is in
/// px of the middle of the frame. The sum of its weights times the solid angles of their pixels, in the same
/// unit, is the falloff's integral * radius_px^2. The table needs the nodes up to sphere_spectrum_px.
Footprint sphere_footprint_at(const FootprintTable& table, const Lens& lens, float radius_px, float x_px,
                              float y_px);

}  // namespace astrosplat
