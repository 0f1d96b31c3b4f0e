// Splat files by their ending: .pda (Maya ASCII particles), .ply, .splats (native). One reader/writer a file:
// pda.*, ply.*, native.*; this is the front door.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

bool is_splat_file(const std::filesystem::path& file);

/// Rows stay in file order (call sort_by_id before rendering). Throws InputError with file and place.
SplatSet read_splats(const std::filesystem::path& file, const Progress& progress = {});

/// Writes to a temporary name, then renames: the file appears whole or not at all. Throws OutputError.
void write_splats(const std::filesystem::path& file, const SplatSet& set, const Progress& progress = {});

}  // namespace astrosplat
