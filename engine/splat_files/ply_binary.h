// Rows of binary PLY files. In: the header, and columns that know their fields. Out: a table filled with the
// element's rows.
#pragma once

#include <cstddef>
#include <filesystem>

#include "core/progress.h"
#include "splat_files/ply_header.h"
#include "splat_files/splat_table.h"

namespace astrosplat {

/// Opens the table and stores the rows of element number `vertex`, in parallel. Throws InputError with the
/// first wrong vertex.
void read_binary_rows(const PlyHeader& header, std::size_t vertex, SplatTable& table,
                      const std::filesystem::path& file, const Progress& progress);

}  // namespace astrosplat
