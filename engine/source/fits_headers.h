// A look at a FITS file's headers before CFITSIO sees them. CFITSIO 4.2 trusts the cards that describe a
// tile-compressed image: with one wrong byte in them it divides by zero, writes out of bounds or aborts. Of
// a table whose sizes it cannot read it takes memory for any number of columns.
#pragma once

#include <filesystem>

namespace astrosplat {

/// Walks all HDUs, also of a gzip file, and checks the cards of the tile compression convention (FITS 4.0,
/// section 10.1) and the sizes of tables. Throws InputError "FILE:HDU n: expected ..." for one that cannot
/// be. Headers that are damaged otherwise are left to CFITSIO.
void check_fits_headers(const std::filesystem::path& file);

}  // namespace astrosplat
