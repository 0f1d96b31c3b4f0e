// Voxels into an OpenVDB file. In: a grid and words about it. Out: a .vdb file that volume renderers read;
// the same bytes for any number of threads.
#pragma once

#include "core/progress.h"
#include "splat_files/write_target.h"
#include "volumes/openvdb/openvdb_module.h"

namespace astrosplat {

/// Atomic. The file's unique tag, which OpenVDB draws at random, is made of the other bytes instead. Throws
/// InputError where the module or the libraries it needs are not installed, OutputError, Cancelled.
void write_openvdb(const WriteTarget& target, const VoxelGrid& grid, const VolumeWords& words,
                   const Progress& progress = {});

}  // namespace astrosplat
