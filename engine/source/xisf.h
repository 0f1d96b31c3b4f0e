// XISF 1.0, PixInsight's own files: monolithic ones, whatever their blocks are compressed with. In: a file.
// Out: what FITS' reader gives, of values, keywords and all (source/fits.h).
#pragma once

#include "source/fits.h"

namespace astrosplat {

bool is_xisf(const fs::path& file);

/// As open_fits_rows: `hdu` is a number from 0 or an id of an image, `plane` a channel; empty: three are
/// colours, a colour filter array is undone. Decompressed values are held. Throws InputError, Cancelled.
FitsRows open_xisf_rows(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                        const Progress& progress);

/// As describe_fits.
std::vector<FitsHdu> describe_xisf(const fs::path& file, const Progress& progress);

}  // namespace astrosplat
