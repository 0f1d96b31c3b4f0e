// Gaussians as USD text (.usda): one ParticleField3DGaussianSplat of OpenUSD's UsdVol (26.03). Atomic, and
// the same bytes for any thread count.
#pragma once

#include "core/progress.h"
#include "gaussians/gaussians.h"
#include "splat_files/write_target.h"

namespace astrosplat {

/// Positions, orientations (w first), scales (standard deviations), opacities and harmonics, those of
/// each together and in the order of their degrees; y up. Shortest numbers that read back to the same floats.
/// Throws OutputError, Cancelled.
void write_gaussian_usda(const WriteTarget& target, const Gaussians& gaussians,
                         const Progress& progress = {});

}  // namespace astrosplat
