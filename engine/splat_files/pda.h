// Maya's ASCII particle files (.pda). In: header (ATTRIBUTES, TYPES, NUMBER_OF_PARTICLES, BEGIN DATA) and one
// line of numbers a particle. Out: SplatSet. Attributes used: position (V), rgbPP (V, linear), opacityPP,
// DistanceFromSurfaceMeshPP, radiusPP (R), whichMeshPP, particleId or id (I or R); any others are skipped by
// their type.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "splat_files/write_target.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Rows in file order. Missing colour is white, missing opacity 1, missing distance 0, missing id the row
/// number. Throws InputError with the line where the file and its own header disagree.
SplatSet read_pda(const std::filesystem::path& file, const Progress& progress = {});

/// Shortest decimal numbers that read back to the same float32, 64-bit ids; the same bytes for any thread
/// count. What PDA has no attribute for (uv, normal, spacing, credit) is left out. Throws OutputError.
void write_pda(const WriteTarget& target, const SplatSet& set, const Progress& progress = {});

/// splat_attributes() of a PDA file.
std::vector<std::string> pda_attributes(const std::filesystem::path& file);

/// splat_count() of a PDA file.
std::int64_t pda_splat_count(const std::filesystem::path& file);

}  // namespace astrosplat
