// Splat files of any format: .pda (Maya ASCII particles), .ply, .splats (native); and read only glTF, USD,
// .spz, .splat and .sog.
// This is the front door; formats.h and native.h have the readers and writers.
#pragma once

#include "core/atomic_file.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// The format is recognised by the file's first bytes, else by its ending. Rows stay in file order (call
/// sort_by_id before rendering). Throws InputError with file and place.
SplatSet read_splats(const fs::path& file, const Progress& progress = {});

/// The columns of a file's splats, by its header alone: some of position, color, alpha, distance, radius, uv,
/// normal, mesh, scale, rotation, harmonics, id. Throws InputError.
std::vector<std::string> splat_attributes(const fs::path& file);

/// How many splats a file, but glTF, says that it holds. Throws InputError.
std::int64_t splat_count(const fs::path& file);

/// Whether a file is of such a format, and no glTF or USD that at its beginning does not speak of Gaussians:
/// those may hold cameras.
bool may_hold_splats(const fs::path& file);

/// In the format of the ending. Writes to a temporary name, then renames: the file appears whole or not at
/// all. Throws OutputError.
void write_splats(const WriteTarget& target, const SplatSet& set, const Progress& progress = {});

}  // namespace astrosplat
