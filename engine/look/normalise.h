// match = "picture": every cell of the picture has the light that it is due, whichever of its positions
// became splats. In: a set and its look. Out: a factor of alpha for each splat that is kept.
#pragma once

#include <vector>

#include "look/kernel.h"

namespace astrosplat {

/// Cells are squares of uv, apart for each mesh, of about 8 splats. The factor of a cell is what its
/// positions would show on average, the sum of probability * alpha * radius^2, over what those that are kept
/// show; from 1/4 to 4. One factor for each splat that shade_run keeps, in order of the set. Empty for a set
/// without uv. Reads the set before its arrays are written over. The same bits with any number of threads.
std::vector<float> picture_factors(const LookRun& run, const SplatSet& set);

}  // namespace astrosplat
