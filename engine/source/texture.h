// Pictures as splat colours: any file OpenImageIO reads, and FITS through CFITSIO. In: one path, or three for
// r, g, b. Out: Texture, linear light, premultiplied, filtered premultiplied and divided by alpha after
// filtering. Also pictures of one channel made from a picture's own light: maps of where dust absorbs it and
// where it is redder or bluer than the rest, and masks of where it is to show, chosen by brightness and
// colour, by an ellipse or by another picture.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/progress.h"
#include "source/mesh.h"
#include "source/prepared_picture.h"
#include "source/source.h"
#include "source/stored_picture.h"

namespace astrosplat {

/// What an infinite pixel becomes: it overflowed a half float.
inline constexpr float half_max = 65504.0f;

/// So many are never reduced while they are read: pictures that are small enough to be enlarged.
inline constexpr std::int64_t texels_read_whole = 1024 * 1024;

/// Where load_texture() has files from, and prepared pictures where settings.prepare wants something.
struct PictureReaders {
    PictureMaker prepared = make_prepared;
    RawReader raw = {};            // none: files are read by rows
    std::int64_t most_texels = 0;  // to which a larger file is reduced while it is read; 0: none
};

struct Texture {
    Image image;    // RGBA, linear, premultiplied; row 0 is the top (v = 1)
    int times = 1;  // as wide and high as the picture that was read (enlarge_small_pictures)
    std::int64_t file_width = 0, file_height = 0;  // px, of a file that was reduced while it was read; else 0
    TextureSettings::Filter filter = TextureSettings::Filter::bilinear;
    TextureSettings::Wrap wrap = TextureSettings::Wrap::clamp;  // never automatic once loaded
    bool divided =
        false;  // colours were divided by alpha (derived or associated alpha): the look need not do it again
    bool alpha_from_light =
        false;  // the file has no alpha, and none was asked for: alpha is the brightest channel
    std::string
        credit;  // from the file's own metadata (XMP/AVM credit, EXIF artist, copyright), may be empty
    Image mask;  // one channel, what apply_mask() multiplies by; without pixels where there is none
    std::string summary;  // one line for messages: size, HDU, limits and stretch chosen
};

/// `default_wrap` is what Wrap::automatic means here. Masks are weighed but not yet applied: shapes that are
/// made of a picture's brightness see all of it. Throws InputError, Cancelled.
Texture load_texture(const std::vector<fs::path>& files, const TextureSettings& settings,
                     TextureSettings::Wrap default_wrap, const Progress& progress = {},
                     const PictureReaders& readers = {});

/// Multiplies the picture by its mask, and forgets the mask.
void apply_mask(Texture& texture);

/// A warning where a picture (RGBA, premultiplied) shows nothing, as none of its pixels had a value or for
/// another reason.
void warn_of_nothing(const Image& image, bool undefined, const std::string& name);

/// Linear light that shows everywhere, but for `border` texels around each picture: negative values become 0,
/// infinite ones half_max, and pixels without a value are filled from around, or 0 where a picture has no
/// other. A warning says of how many. Throws Cancelled.
void fill_values(std::span<Image> pictures, int border, const fs::path& file, const Progress& progress);

/// Reads a picture without any colour or alpha treatment, for thickness maps: RGB as stored (0..1 for
/// integers; 0 where there is no value, half_max where it is infinite), row 0 on top. Throws InputError.
Image load_raw_image(const fs::path& file);
/// The same of a mask: where it has one colour and is painted in its alpha, that alpha.
Image load_mask(const fs::path& file);
/// One channel that grows towards the nearest: the depths of a channel Z, turned about, or else the mean of
/// the colours. What is no number, 1e9 and more, and in files of floats a largest value more than 100 times
/// as far as all others is sky, which is as far as the farthest. Says the range. Throws InputError.
Image load_depths(const fs::path& file);
/// load_raw_image(), or in its place the map made of the picture's light (derived_picture), grey.
Image load_map(const fs::path& file, Derived derive);

/// Reads a picture as linear light, premultiplied RGBA, for comparisons. Throws InputError, Cancelled.
Image load_linear_image(const fs::path& file, const Progress& progress = {});

/// Reads a picture for an environment, as linear light over black: RGB, with room for a border of so many
/// texels around it, as fill_values() leaves it. One picture, or the six faces (+x -x +y -y +z -z) of an
/// OpenEXR cube map. Claims the memory of mip levels too. Throws InputError, Cancelled.
std::vector<Image> load_environment_pictures(const fs::path& file, int border, const Progress& progress = {});

/// Straight colour and alpha at one place of a picture.
struct TextureSample {
    glm::vec3 color;  // linear, straight; 0 where alpha is 0
    float alpha;      // 0..1
};

/// Filtered lookup at uv (v = 0 is the bottom row). `box_texels` is the side, in texels along u and v, of the
/// box averaged by Filter::area; the other filters ignore it. Alpha of exactly 0 comes back as exactly 0.
TextureSample sample(const Texture& texture, glm::vec2 uv, glm::vec2 box_texels = glm::vec2(0.0f));

/// One channel of the picture's size, 0..1, of `light` (RGB first, linear, premultiplied, >= 0); not for
/// none.
/// - dust: what an absorbing layer takes away, 1 - T. T = max(R, G, B) over that of a picture whose dark
///   details are filled: the sum of max(0, P_k - P_k+1) over bands P_k = mu_k clamp(1 - sd_k / (2 mean_k),
///   1/4, 1), P_0 = light, with blurs of 1.2, 2.4 ... px up to 80 px at a width of 1920. T is 0.1 at least.
/// - h_alpha: the share of red light beyond s (G + B) / 2, s the median of R over (G + B) / 2 where the
///   picture is lit: the continuum is taken off.
/// - young_stars: the share of blue light beyond s (R + G) / 2 in the same way.
/// Light of 0.002 of white counts as noise in all of them. The same bits with any number of threads.
Image derived_picture(const Image& light, Derived kind);

/// One channel of the picture's size, 0..1: the product over masks of the product of their terms and the
/// largest of their alternatives; `invert` makes 1 - w of a mask, or of an alternative. `light` is RGBA,
/// linear, premultiplied: colours are those seen over black. Edges are linear ramps of the width `feather`
/// about the border. Hue and saturation as in HSV, of display values; grey has no hue and is outside.
/// Throws InputError where an image cannot be read.
Image mask_weights(const Image& light, std::span<const MaskParams> masks);

}  // namespace astrosplat
