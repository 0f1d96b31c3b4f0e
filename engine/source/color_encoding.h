// What a picture's file says of its colours: an ICC profile of matrix and curves, EXR's chromaticities, PNG's
// chunks. In: a file and what OpenImageIO tells of it. Out: curves and a matrix that make linear light of
// Rec. 709 of what is stored.
#pragma once

#include <glm/mat3x3.hpp>

#include "core/image.h"
#include "core/standard.h"

namespace astrosplat {

/// From stored to linear values, odd-symmetric below 0.
struct TransferCurve {
    enum class Kind { linear, srgb, parametric, table, pq, hlg } kind = Kind::linear;
    /// Parametric: (a x + b)^g + e from d on, c x + f below (ICC.1:2022, table 68): g a b c d e f.
    std::array<double, 7> parameters{1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    std::vector<float> table;  // of 0 to 1 in equal steps
    double operator()(double x) const;
};

struct ColorEncoding {
    std::string name;  // "ICC profile 'Display P3'"
    std::array<TransferCurve, 3> curves;
    glm::dmat3 to_rec709{1.0};
    std::array<std::vector<float>, 3> of_integers;  // linear values of each integer; empty: of floats

    /// All three curves are of this kind, and the primaries those of Rec. 709.
    bool is_rec709(TransferCurve::Kind kind) const;
};

/// Colours of an ICC profile. Null with the reason in `problem` where it is none of matrix and curves. What
/// differs from sRGB by less than rounding does is sRGB.
std::shared_ptr<const ColorEncoding> icc_encoding(std::span<const std::uint8_t> profile,
                                                  std::string& problem);

/// Colours of primaries (red, green, blue, white; x and y each) over one curve; null where they are none,
/// with `name` in `problem`. XYZ's own, as EXR has them, are not adapted: what is white of D65 is white.
inline constexpr std::array xyz_chromaticities{1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f / 3.0f, 1.0f / 3.0f};
std::shared_ptr<const ColorEncoding> chromaticity_encoding(std::span<const float, 8> xy, TransferCurve curve,
                                                           std::string name, std::string& problem);

/// Of the chunks cICP, sRGB, gAMA and cHRM of a PNG file, by their order of precedence (PNG 3, 4.3); where it
/// has a profile, that comes before the last three and is not looked at here: libpng reads it, or has not,
/// which is a problem. Null: none says anything.
std::shared_ptr<const ColorEncoding> png_encoding(const fs::path& file, bool has_profile,
                                                  std::string& problem);

/// Of an animated PNG; 1 of others.
std::int64_t png_frames(const fs::path& file);

/// Of cameras' JPEG files that say so without a profile (DCF 2.0, option R03).
std::shared_ptr<const ColorEncoding> adobe_rgb_encoding();

/// By OpenImageIO's names of a curve over Rec. 709: Linear, Rec709, and Gamma with its number. Null: another.
std::shared_ptr<const ColorEncoding> named_encoding(std::string_view name, double gamma);

/// What a TIFF's own tags say (TIFF 6.0, section 20): primaries and white as above; a table each channel.
struct TiffColors {
    std::optional<std::array<float, 8>> primaries;
    std::array<std::vector<float>, 3> transfer;  // of 0 to 1
};
/// Where one is missing, sRGB's of integers up to `largest`, else linear light. Null: neither says anything.
std::shared_ptr<const ColorEncoding> tiff_encoding(const TiffColors& tiff, double largest,
                                                   std::string& problem);

/// The same with its tables, for a picture's integers up to `max_integer` (255, 65535; else without).
std::shared_ptr<const ColorEncoding> with_tables(std::shared_ptr<const ColorEncoding> encoding,
                                                 double max_integer);

/// Stored colours, of 3 or 4 channels, become linear light; where `associated` they were multiplied by alpha.
void decode_colors(Image& image, const ColorEncoding& encoding, bool associated);

}  // namespace astrosplat
