// Columns straight into a native file, part of space by part, for sets larger than memory. In: what
// make_columns() takes. Out: the .splats file that write_native() makes of their lit_splats(), byte for byte.
// It searches twice: once to know how many splats there are and where, then once for each part.
#pragma once

#include <cstdint>
#include <span>

#include "core/progress.h"
#include "generate/lattice.h"
#include "source/textured_mesh.h"
#include "splat_files/write_target.h"

namespace astrosplat {

/// Returns how many splats the file has. Parts take about `room_bytes` of memory, if the smallest part of
/// space does not take more. Throws OutputError, Cancelled, and InputError where there is no memory for the
/// smallest part.
std::int64_t write_columns(const WriteTarget& target, std::span<const TexturedMesh> meshes,
                           const Lattice& lattice, double max_distance, double jitter, std::uint32_t seed,
                           std::int64_t room_bytes, const Progress& progress = {});

}  // namespace astrosplat
