// FITS through CFITSIO. In: a path. Out: one plane of data values, or what the file holds; of data values
// numbers from 0 (black) to 1 (white). (OpenImageIO 2.4's own FITS reader shifts the rows
// and forgets BSCALE.)
#pragma once

#include "core/buffer.h"
#include "core/progress.h"
#include "source/color_encoding.h"
#include "source/object_metadata.h"
#include "source/sky_grid.h"
#include "source/source.h"

namespace astrosplat {

/// Of the finite ones among the values. All zero when there are none.
struct ValueRange {
    double min = 0.0, max = 0.0;
    double black = 0.0;  // 0.25 percentile
    double white = 0.0;  // 99.75 percentile
};

/// Percentiles are exact, interpolated linearly between ranks p (n - 1) as numpy does.
ValueRange value_range(std::span<const double> values);

/// The same of values that need not be held: `hand_out` gives all of them to its argument, in parts. It is
/// called five times.
using ValueTaker = std::function<void(std::span<const double>)>;
ValueRange value_range(const std::function<void(const ValueTaker& take)>& hand_out);

struct Limits {
    double black = 0.0;
    double white = 1.0;
};

/// The limits settings ask for, the percentiles where they leave them open. Both are finite and black <
/// white: a picture of one value gets white = black + 1. Throws InputError, naming `file`, when set limits
/// contradict that.
Limits choose_limits(const ValueRange& range, const TextureSettings& settings, const std::string& file);

/// x = (value - black) / (white - black) cut to [0, 1]; then linear x, asinh(x / softening) / asinh(1 /
/// softening) or log(1000 x + 1) / log(1001) (ds9's). NaN stays NaN. `stretch` is not automatic.
class StretchCurve {
  public:
    StretchCurve(const Limits& limits, TextureSettings::Stretch stretch, double softening);
    double operator()(double value) const;

  private:
    Limits limits_;
    TextureSettings::Stretch stretch_;
    double softening_;
    double of_white_ = 1.0;  // what the curve makes of 1 before it is scaled
};

/// A look at a file, or at what it was unpacked to, before CFITSIO sees it, which trusts what is checked
/// here: of all HDUs the cards of the tile compression convention (FITS 4.0, section 10.1) and the sizes of
/// tables. Throws InputError "FILE:HDU n: expected ..." for one that cannot be. Headers that are damaged
/// otherwise are left to CFITSIO.
void check_fits_headers(const fs::path& file, const std::string* unpacked = nullptr);

/// By content, or a packed file by its name. XISF, which holds the same (source/xisf.h), is FITS to all that
/// follows.
bool is_fits(const fs::path& file);

struct FitsHdu {
    int number = 0;                  // 0: the primary HDU
    std::string name;                // EXTNAME, may be empty
    std::string kind;                // "image", "compressed image", "table", "empty"
    int bitpix = 0;                  // of images: 8 16 32 64 -32 -64
    std::vector<std::int64_t> axes;  // NAXIS1 first
    bool picture = false;            // has at least two axes (those of length 1 do not count beyond two)
    ValueRange range;                // of the whole HDU; only for images
    std::int64_t nan_count = 0;      // undefined values: NaN or BLANK; only for images
};

/// All HDUs with their statistics. Throws InputError, Cancelled.
std::vector<FitsHdu> describe_fits(const fs::path& file, const Progress& progress = {});

/// Whether an HDU holds a picture. Throws InputError.
bool has_fits_picture(const fs::path& file);

/// Throws InputError unless one of the HDUs holds a picture.
void require_fits_picture(const fs::path& file);

struct FitsPlane {
    std::int64_t width = 0, height = 0;  // px
    int channels = 1;                    // 3: red, green and blue of each pixel
    Buffer<double> values;  // physical (BSCALE, BZERO applied), row 0 on top; NaN where undefined
    int hdu = 0;
    std::string name;                   // EXTNAME
    std::string what;                   // "plane 1 of 4", "3 planes as red, green and blue"; may be empty
    std::string credit;                 // AUTHOR or ORIGIN
    std::string object;                 // OBJECT; may be empty
    SpectralBlock exposure;             // TELESCOP, INSTRUME and FILTER
    std::optional<double> distance_ly;  // DISTANCE, where its comment tells the unit
    FitsSky sky;
    std::shared_ptr<const ColorEncoding>
        colors;  // of a profile, for values that are not stretched; null: none
};

/// A plane that is handed out by rows.
struct FitsRows {
    FitsPlane plane;  // without its values
    /// Writes rows from `begin` to `end`, from the top. Throws InputError, Cancelled.
    std::function<void(std::int64_t begin, std::int64_t end, double* values)> read;
};

/// `hdu`: "auto", a number from 0 (the primary HDU), or an EXTNAME in any case; auto takes SCI where there is
/// one, else the first with a picture that is no mask, weight or error and not blank, and says so where there
/// are several. `plane` counts from 0 over the axes beyond two (of values that are stored by pixel, over the
/// first); empty: three of them are a colour picture unless their axis is one of a spectrum or of
/// polarisation, a plane with BAYERPAT or COLORTYP is one as well (its missing values are means of their
/// neighbours'), of others the first that is not blank is taken, with a warning. ROWORDER is followed. Throws
/// InputError, Cancelled.
FitsRows open_fits_rows(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                        const Progress& progress = {});
FitsPlane read_fits(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                    const Progress& progress = {});
/// All values of what was opened. Throws InputError, Cancelled.
FitsPlane whole_plane(FitsRows rows, const fs::path& file);

}  // namespace astrosplat
