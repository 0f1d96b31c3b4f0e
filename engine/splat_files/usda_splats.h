// Gaussians of USD as text (.usda): ParticleField3DGaussianSplat of OpenUSD's UsdVol (26.03). In: such a
// file. Out: SplatSet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// All Gaussians that the stage defines, in its order, each prim's placed by its own and its parents'
/// transforms at time 0 (turned, mirrored and scaled alike along all axes, else InputError) and with y up; id
/// is the row number. Lists are of floats or halves; what a prim does not list is the schema's: no turn,
/// scales and opacities of 1, middle grey. Harmonics are display values. Nothing that the file refers to is
/// opened, and no time samples of the lists are read. Throws InputError.
SplatSet read_usda_splats(const std::filesystem::path& file, const Progress& progress = {});

/// splat_attributes() of a .usda.
std::vector<std::string> usda_splat_attributes(const std::filesystem::path& file);

/// splat_count() of a .usda.
std::int64_t usda_splat_count(const std::filesystem::path& file);

/// Whether it speaks of Gaussians at its beginning, or cannot be read; others may hold cameras.
bool may_hold_usda_splats(const std::filesystem::path& file);

}  // namespace astrosplat
