// Picture files as stored, before any colour or alpha treatment: OpenImageIO behind one plain struct.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "image/resample.h"

namespace astrosplat {

struct Picture {
    Image image;  // 3 channels, or 4 with the file's alpha; integers scaled to 0..1; row 0 on top
    double max_integer = 0.0;  // largest value of integer files (255, 65535); 0 for float files
    bool associated = false;   // the colours are already multiplied by the file's alpha
    bool cube = false;         // an environment: six square faces +x -x +y -y +z -z one above the other
    std::string credit;        // may be empty
    std::string summary;       // "1920x1200 px, uint8"

    bool has_alpha() const { return image.channels == 4; }
};

/// Reads a picture in any format of core/file_format.h but FITS, turned as its orientation tag says. Gray and
/// single-channel pictures become r = g = b; luminance/chroma EXR becomes RGB; where an EXR's data window
/// differs from its display window, the display window is filled with what lies in it (empty elsewhere).
/// Throws InputError, Cancelled.
Picture read_picture(const fs::path& file, const Progress& progress = {});

/// The same by rows, which `progress` hears of. A picture that has to be turned is held as a whole.
struct PictureRows {
    Picture picture;  // without its pixels
    ImageRows rows;   // throw InputError, Cancelled
};
PictureRows open_picture_rows(const fs::path& file, const Progress& progress = {});

/// Throws InputError unless the file's headers promise a picture, also in FITS.
void require_picture(const fs::path& file);

}  // namespace astrosplat
