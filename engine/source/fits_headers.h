// A look at a FITS file before CFITSIO sees it. CFITSIO 4.2 trusts the cards that describe a tile-compressed
// image: with one wrong byte in them it divides by zero, writes out of bounds or aborts. Of a table whose
// sizes it cannot read it takes memory for any number of columns, and on a damaged gzip tile asks for more
// and more of it without end.
#pragma once

#include <fitsio.h>

#include <filesystem>

namespace astrosplat {

/// Walks all HDUs, also of a gzip file, and checks the cards of the tile compression convention (FITS 4.0,
/// section 10.1) and the sizes of tables. Throws InputError "FILE:HDU n: expected ..." for one that cannot
/// be. Headers that are damaged otherwise are left to CFITSIO.
void check_fits_headers(const std::filesystem::path& file);

/// Inflates every gzip tile of the current HDU into nothing. Throws InputError "FILE: tile n: expected ..."
/// for one that ends early, holds anything else or more than its pixels. Pictures compressed otherwise pass.
void check_gzip_tiles(const std::filesystem::path& file, fitsfile* in);

}  // namespace astrosplat
