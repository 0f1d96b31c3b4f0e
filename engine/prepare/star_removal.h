// A picture without its stars. In: linear light. Out: a list of stars, as such or as a table, and the picture
// less their profiles; in the end with its surroundings continued where stars were. Whatever is in one is not
// in the other. Of stars too bright for the picture what can be seen is fitted: their wings.
#pragma once

#include "core/progress.h"
#include "prepare/star_fit.h"

namespace astrosplat {

struct StarSettings {
    double threshold = 5.0;  // > 0: least height of a star over the noise of heights
    double saturation =
        std::numeric_limits<double>::infinity();  // light from which a channel tells nothing more
};

struct StarField {
    std::vector<PictureStar> stars;  // saturated ones first, then by rows of their first sighting
    StarWidths widths;               // of most that are not saturated
    Image image;                     // the picture less every star's profile
    PixelMask covered;  // pixels of saturated cores and their spikes: the image tells nothing there
};

/// Finds and fits the stars of the first three channels: candidates are peaks above the local noise, fitted
/// in three rounds with all others taken away, and kept when they are as wide as the field's stars and look
/// like a star's profile. The same bits with any number of threads. Throws Cancelled.
StarField find_stars(const Image& image, const StarSettings& settings, const Progress& progress = {});

/// The pixels where a channel reaches `level`.
PixelMask saturated_pixels(const Image& image, double level);

/// Round saturated patches from which the light falls off steeply all around; `noise` is that of a height,
/// for all of them. Patches of less than 9 pixels are left to the ordinary search. Subtracts the stars'
/// profiles from the picture.
std::vector<PictureStar> take_saturated_stars(Image& image, const PixelMask& saturated, double noise);

/// The pixels of a star that its profile does not describe: its core and diffraction spikes, found in the
/// picture less the star as rays that stand out of the ring they cross.
void mark_core_and_spikes(const Image& without, const PictureStar& star, PixelMask& mask);

struct StarRemoval {
    Image starless;                  // channels as the picture's; those behind the third are unchanged
    std::vector<PictureStar> stars;  // the brightest (by flux of all channels) first
};

/// Takes the stars of the first three channels away. Where a star stood far above the noise, its profile is
/// not trusted to leave the noise alone: the pixels are filled from around it. No pixel falls below 0 that
/// did not before. The same bits with any number of threads. Throws Cancelled.
StarRemoval remove_stars(const Image& image, const StarSettings& settings, const Progress& progress = {});

/// Bytes that it takes at its peak besides the picture.
std::int64_t star_removal_bytes(const Image& image);

/// The first line of every star_table(): tells it from a table of another program that has the same name.
inline constexpr std::string_view star_table_mark = "# stars that astrosplat prepare took out of a picture";

/// A line with the mark and one with the columns' names, then a line a star. Columns: x, y in px from the
/// picture's top left corner (the middle of its first pixel is 0.5, 0.5); u, v on the picture (v = 0 is its
/// lower edge); flux_r, flux_g, flux_b, the linear light summed over all pixels; sigma_px, the standard
/// deviation of the Gaussian that is as wide at half height; saturated, 0 or 1.
std::string star_table(std::span<const PictureStar> stars, std::int64_t width, std::int64_t height);

}  // namespace astrosplat
