// The one place where picture files are opened with OpenImageIO: by a list of formats, each with its own
// plug-in, and without what libraries print of their own; and what it does not tell of a file, as
// whether a JPEG file is whole: libjpeg fills the missing part of a cut file with grey and says nothing.
// Include in .cpp files only, behind <fmt/format.h>: OpenImageIO's headers are large and bring a copy of fmt
// with other settings.
#pragma once

#include <OpenImageIO/imageio.h>

#include "core/standard.h"
#include "source/color_encoding.h"

namespace astrosplat {

/// While it lives, what this thread writes to the C stream stderr is dropped: libpng prints its errors there,
/// which our own message repeats.
class QuietStderr {
  public:
    QuietStderr();
    ~QuietStderr();
    QuietStderr(const QuietStderr&) = delete;
    QuietStderr& operator=(const QuietStderr&) = delete;
};

/// Opens a picture in one of the formats of core/file_format.h, with unassociated alpha as it is stored.
/// Throws InputError: not a readable regular file, another kind of file, a damaged header.
std::unique_ptr<OIIO::ImageInput> open_picture(const fs::path& file);

/// All channels of rows begin .. end from the top of what is stored, as `format`. False: damaged.
bool read_rows(OIIO::ImageInput& picture, int begin, int end, OIIO::TypeDesc format, void* values);

/// Throws InputError "FILE: cannot be read as a picture: REASON", the first line of it.
[[noreturn]] void fail_picture(const fs::path& file, const std::string& reason);

/// Follows the markers of a JPEG file (ITU-T T.81, B.1.1) to its end-of-image marker; false where the file
/// ends first. Files of other formats are not judged: true.
bool jpeg_is_whole(const fs::path& file);

/// Throws InputError where a TIFF does not say its bits: they are one, and OpenImageIO reads eight; and where
/// it was cut short, as OpenImageIO reads black. What stands for no value in floats (GDAL_NODATA), if
/// anything.
std::optional<double> check_tiff(const fs::path& file, int page);

/// What a TIFF's tags say of its colours.
TiffColors colors_of_tiff(const fs::path& file, int page);

/// False where BMP's fourth byte means nothing: without a mask for it.
bool bmp_has_alpha(const fs::path& file);

/// Says how many pictures a PNG (frames) or JPEG (CIPA DC-007) holds, of which OpenImageIO has the first.
void warn_of_hidden_pictures(const fs::path& file, std::string_view format);

/// 255, 65535 or 4294967295; 0 of floats.
double largest_integer(const OIIO::ImageSpec& spec);

/// What a picture's file says of its colours, or null. What is not followed is said.
std::shared_ptr<const ColorEncoding> colors_of_picture(const fs::path& file, std::string_view format,
                                                       const OIIO::ImageSpec& spec, int page);

/// By what a Radiance file's values have to be divided to be radiances (its format's EXPOSURE and COLORCORR,
/// both cumulative), which OpenImageIO leaves to others.
std::array<float, 3> radiance_factors(const fs::path& file);

/// Of netpbm's whole numbers; 0 of bits and floats. Throws InputError where it is none, from 1 to 65535, or
/// one beyond 15 bits, whose values OpenImageIO 2.4 scales wrongly.
double largest_of_pnm(const fs::path& file);

/// What a WebP file's chunk EXIF says, which OpenImageIO does not tell.
void add_webp_exif(const fs::path& file, OIIO::ImageSpec& spec);

}  // namespace astrosplat
