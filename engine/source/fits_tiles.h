// A look at the gzip tiles of a tile-compressed FITS picture before CFITSIO inflates them. On a damaged one
// CFITSIO 4.2 asks for more and more memory without end.
#pragma once

#include <fitsio.h>

#include <filesystem>

namespace astrosplat {

/// Inflates every gzip tile of the current HDU into nothing. Throws InputError "FILE: tile n: expected ..."
/// for one that ends early, holds anything else or more than its pixels. Pictures compressed otherwise pass.
void check_gzip_tiles(const std::filesystem::path& file, fitsfile* in);

}  // namespace astrosplat
