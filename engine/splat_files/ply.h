// PLY point clouds (.ply): ASCII, binary little-endian and big-endian. In: element vertex with x y z and,
// where present, red green blue alpha (float 0..1, linear; uchar and ushort: sRGB colour, linear alpha),
// radius, distance, id (with id_high for its upper 32 bits, as PLY has no 64-bit numbers), mesh, s t. All
// else is skipped. Or Gaussians as 3D Gaussian Splatting stores them (ply_gaussians.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "splat_files/write_target.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Rows in file order. Missing colour is white, missing alpha 1, missing distance 0, missing id the row
/// number. Throws InputError with the header's line or the vertex.
SplatSet read_ply(const std::filesystem::path& file, const Progress& progress = {});

/// Binary little-endian, all numbers as they are in memory; id_high only where an id needs it. A credit
/// becomes a comment; normal and spacing are left out. Throws OutputError.
void write_ply(const WriteTarget& target, const SplatSet& set, const Progress& progress = {});

/// splat_attributes() of a PLY file.
std::vector<std::string> ply_attributes(const std::filesystem::path& file);

/// splat_count() of a PLY file.
std::int64_t ply_splat_count(const std::filesystem::path& file);

}  // namespace astrosplat
