// What the look's and the source's controls draw their handles over: how a set's distances spread, how its
// picture's values do, and which radii it has. In: a set and the source it came from.
#pragma once

#include <glm/vec2.hpp>

#include "edit/status.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// The values are those of the first picture of the first mesh: data values for FITS, else the largest
/// channel as stored. Without such a picture, or where it cannot be read, they are empty.
LayerHistograms histograms(const SplatSet& set, const SourceParams& source);

/// Smallest and largest radius in scene units that a look without radii gives: the file's own, or 0.6 voxel
/// diagonals; 0, 0 where neither is known.
glm::dvec2 unset_radius(const SplatSet& set);

}  // namespace astrosplat
