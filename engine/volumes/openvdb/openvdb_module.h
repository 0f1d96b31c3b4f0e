// The one place that knows OpenVDB, as a module of its own: loading it with what it needs takes as long as
// starting the program, so openvdb_file loads it when a file is written. In: a grid and words about it. Out:
// a .vdb file's bytes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "volumes/voxel_grid.h"

namespace astrosplat {

using VolumeWords = std::vector<std::pair<std::string, std::string>>;

/// What write_openvdb expects under this name in the module.
inline constexpr const char* openvdb_entry = "astrosplat_openvdb_bytes";

/// Grids `density` (fog volume), `emission` and `Cd`, all with the same transform. Returns false, and what is
/// wrong in `bytes`, when that fails. The file's unique tag is random.
using OpenvdbBytes = bool(const VoxelGrid& grid, const VolumeWords& words, std::string& bytes);

}  // namespace astrosplat
