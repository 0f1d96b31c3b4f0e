// Gaussians of glTF 2.0 files (.glb, .gltf), as Khronos' KHR_gaussian_splatting has them: POINTS with
// POSITION, ROTATION (x y z w), SCALE (linear), OPACITY and SH_DEGREE_l_COEF_n. In: such a file. Out:
// SplatSet.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// All Gaussians of the scene, in the order of its nodes, each node's placed by it (turned, mirrored and
/// scaled alike along all axes, else InputError); id is the row number. Compressed ones are refused. Throws
/// InputError.
SplatSet read_gltf_splats(const std::filesystem::path& file, const Progress& progress = {});

/// splat_attributes() of a glTF file.
std::vector<std::string> gltf_splat_attributes(const std::filesystem::path& file);

/// Whether a glTF file speaks of Gaussians at its beginning, or cannot be read; others may hold
/// cameras.
bool may_hold_gltf_splats(const std::filesystem::path& file);

}  // namespace astrosplat
