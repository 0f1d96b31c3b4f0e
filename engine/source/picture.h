// Picture files as stored, before any colour or alpha treatment: OpenImageIO behind one plain struct.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "image/resample.h"
#include "source/color_encoding.h"
#include "source/object_metadata.h"

namespace astrosplat {

struct Picture {
    Image image;  // 3 channels, or 4 with the file's alpha; integers scaled to 0..1; row 0 on top
    double max_integer = 0.0;  // largest value of integer files (255, 65535, netpbm's own); 0 for float files
    bool associated = false;   // the colours are already multiplied by the file's alpha
    bool distances = false;    // of a channel of depths: the larger, the farther
    bool cube = false;         // an environment: six square faces +x -x +y -y +z -z one above the other
    std::shared_ptr<const ColorEncoding> colors;  // what the file says of them; null: nothing
    std::string credit;                           // may be empty
    std::string summary;                          // "1920x1200 px, uint8"

    bool has_alpha() const { return image.channels == 4; }
};

/// Reads a picture in any format of core/file_format.h but FITS, turned as its orientation tag says. Gray and
/// single-channel pictures become r = g = b; luminance/chroma EXR becomes RGB; where an EXR's data window
/// differs from its display window, the display window is filled with what lies in it (empty elsewhere).
/// Pixels that are not square become more of them; Radiance's values are divided by its exposure.
/// Throws InputError, Cancelled.
///
/// `part`: of several pictures in a file the number from 0 or the name of an EXR part or layer, or the
/// number of a TIFF page; "auto": the first part with red, green and blue, else with luminance; the largest
/// page that is not reduced and not blank, or three of ImageJ's that are channels. Where several would do, a
/// warning says which.
///
/// Of depths "auto" is the first part with a channel Z or depth.Z, and that channel is taken.
enum class Wanted { colors, depths };
Picture read_picture(const fs::path& file, const Progress& progress = {}, const std::string& part = "auto",
                     Wanted wanted = Wanted::colors);

/// The same by rows, which `progress` hears of. A picture that has to be turned is held as a whole.
struct PictureRows {
    Picture picture;  // without its pixels
    ImageRows rows;   // throw InputError, Cancelled
};
PictureRows open_picture_rows(const fs::path& file, const Progress& progress = {},
                              const std::string& part = "auto", Wanted wanted = Wanted::colors);

/// The first channels of three pictures of one size as red, green and blue.
ImageRows joined_channels(const std::array<ImageRows, 3>& channels);

/// All pictures in a file, "0: 60x40 px, 'rgba'", and which of them is taken.
struct PictureParts {
    std::vector<std::string> parts;
    int taken = 0;
};
PictureParts describe_parts(const fs::path& file);

/// By XMP or the cards of FITS; a credit also by IPTC or EXIF. Throws InputError.
ObjectMetadata read_picture_metadata(const fs::path& file);

/// Throws InputError unless the file's headers promise a picture, also in FITS.
void require_picture(const fs::path& file);

}  // namespace astrosplat
