// Voxels into an OpenVDB file, and the module that does it: the one place that knows OpenVDB, apart from the
// program because loading it with what it needs takes as long as starting that. In: a grid and words about
// it. Out: a .vdb file that volume renderers read; the same bytes for any number of threads.
#pragma once

#include "core/atomic_file.h"
#include "core/progress.h"
#include "volumes/voxel_grid.h"

namespace astrosplat {

using VolumeWords = std::vector<std::pair<std::string, std::string>>;

/// Atomic. The file's unique tag, which OpenVDB draws at random, is made of the other bytes instead. Throws
/// InputError where the module or the libraries it needs are not installed, OutputError, Cancelled.
void write_openvdb(const WriteTarget& target, const VoxelGrid& grid, const VolumeWords& words,
                   const Progress& progress = {});

/// The name under which write_openvdb finds its function in the module.
inline constexpr const char* openvdb_entry = "astrosplat_openvdb_bytes";

/// Grids `density` (fog volume), `emission` and `Cd`, all with the same transform. Returns false, and what is
/// wrong in `bytes`, when that fails. The file's unique tag is random.
using OpenvdbBytes = bool(const VoxelGrid& grid, const VolumeWords& words, std::string& bytes);

}  // namespace astrosplat
