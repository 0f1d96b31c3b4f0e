// A picture file's values on their way to linear light: what load_texture and the preparation of pictures
// begin with. In: a file. Out: its values, FITS stretched, and then linear ones.
#pragma once

#include "source/fits.h"
#include "source/picture.h"
#include "source/source.h"

namespace astrosplat {

// A file before any setting but FITS' HDU and plane was looked at: the same for all levels.
struct RawPicture {
    Picture picture;                // without pixels where there is a plane
    std::optional<FitsPlane> fits;  // of FITS files
    ValueRange range;               // of its values
};

/// Throws InputError, Cancelled.
RawPicture read_raw(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                    const Progress& progress);

/// The source of load_texture()'s files: read_raw(), or a store of its earlier results.
using RawReader = std::function<RawPicture(const fs::path& file, const std::string& hdu,
                                           std::optional<int> plane, const Progress& progress)>;

// A picture as stored, with what is known about its values.
struct Stored {
    Picture picture;
    bool display_values = false;  // sRGB, when neither settings nor the file say what its colours are
};

/// The meaning of automatic: asinh.
TextureSettings::Stretch stretch_of(const TextureSettings& settings);

/// The colours that a plane's profile names, where they are followed; stretched values are sRGB's, and a
/// profile of others is a warning. Null: none.
std::shared_ptr<const ColorEncoding> followed_colors(const FitsPlane& plane, TextureSettings::Stretch stretch,
                                                     const fs::path& file);

/// FITS is stretched between its limits. Throws InputError, which names `file`.
Stored stored_of(RawPicture raw, const TextureSettings& settings, const fs::path& file);

/// A picture's values by rows. A FITS plane of more than `most_held` values is not held: it is read five
/// times for its limits, where they are not set, and once more.
struct StoredRows {
    Stored stored;   // without its pixels
    ImageRows rows;  // throw InputError, Cancelled
};
StoredRows rows_of(Stored stored);
StoredRows open_stored(const fs::path& file, const TextureSettings& settings, const Progress& progress,
                       std::int64_t most_held = std::int64_t{1} << 26);

/// The same at once. Throws InputError, Cancelled.
Stored read_stored(const fs::path& file, const TextureSettings& settings, const Progress& progress);

/// "sRGB", "linear", or the name of what the file says of its colours.
std::string colors_of(const Stored& stored, TextureSettings::Colorspace colorspace);

/// To linear light of Rec. 709. `premultiplied`: colours that the file multiplied by its alpha
/// are to stay so.
void make_linear(Stored& stored, TextureSettings::Colorspace colorspace, bool premultiplied);

/// Linear light, premultiplied RGBA; alpha is 1 where the file has none.
Image linear_image(Stored stored, TextureSettings::Colorspace colorspace);

}  // namespace astrosplat
