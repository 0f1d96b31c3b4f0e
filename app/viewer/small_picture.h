// A picture file made small while it is read, for lists and for playing. In: a file. Out: its pixels as they
// are stored, light or display values, on black.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

struct SmallPicture {
    Image image;                         // RGBA, opaque; what had no value is black
    bool light = false;                  // linear, with the primaries of Rec. 709; else display values
    std::int64_t width = 0, height = 0;  // px in the file
};

/// Its longer side is at most `most_px`. FITS is stretched as where nothing is set. Throws InputError,
/// Cancelled.
SmallPicture read_small_picture(const std::filesystem::path& file, std::int64_t most_px,
                                const Progress& progress = {});

}  // namespace astrosplat
