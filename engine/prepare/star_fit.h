// One star measured: its place, its light, and how that spreads over pixels, as a Gaussian or one of some
// Moffat profiles, round, of peak 1. In: a picture and about where the star is. Out: its numbers.
#pragma once

#include "core/image.h"
#include "detect/parts.h"

namespace astrosplat {

inline constexpr int star_shapes = 5;  // 0 is the Gaussian, then Moffat profiles with ever stronger wings
inline constexpr double fwhm_of_sigma = 2.35482004503;  // of a Gaussian: 2 sqrt(2 ln 2)

struct StarProfile {
    double fwhm_px = 2.0;  // full width at half maximum, > 0
    int shape = 0;         // 0 .. star_shapes - 1
};

/// The scaled distance u that profiles are functions of is unit_of(profile)
/// times the squared distance (px^2).
double unit_of(const StarProfile& profile);

/// The profile and its derivative by u, at u >= 0.
struct ProfileValue {
    double value, slope;
};
ProfileValue profile_at(int shape, double u);

/// Its sum over all pixels, px^2.
double integral_of(const StarProfile& profile);

/// The distance beyond which it is below `share` (0..1) of the peak, px.
double reach_of(const StarProfile& profile, double share);

struct PictureStar {
    double x = 0.0, y = 0.0;  // px from the top left corner; the middle of the first pixel is (1/2, 1/2)
    double seen_x = 0.0, seen_y = 0.0;  // where it was first seen, px: a fit does not leave that place
    StarProfile profile;
    std::array<double, 3> amplitude{};  // of r, g, b: light of the peak above the background
    double noise = 0.0;                 // what a mean amplitude found by chance would be, > 0
    double pixel_noise = 0.0;           // of the mean of r, g, b in one pixel, > 0
    double core_px = 0.0;               // radius of what is saturated, 0 where the peak is seen
    bool saturated = false;             // some of its pixels reach the picture's limit
    double misfit = 0.0;                // of the fit near the middle, root mean square, in light

    double mean_amplitude() const { return (amplitude[0] + amplitude[1] + amplitude[2]) / 3.0; }
    double signal_to_noise() const { return mean_amplitude() / noise; }
    /// Sum over all pixels.
    double flux(int channel) const { return amplitude[channel] * integral_of(profile); }
    /// Width of the Gaussian that is as wide at half of its height, px.
    double sigma_px() const { return profile.fwhm_px / fwhm_of_sigma; }
};

/// The common profile of the stars of a picture.
struct StarWidths {
    int shape = 0;
    double fwhm_px = 2.0;     // median
    double log_spread = 0.5;  // standard deviation of the widths' logarithms, > 0
};

/// Fits place, width and height of a star, and the slope of the background under it, to the mean of the
/// first three channels by least squares (Levenberg and Marquardt), the width held near `widths` as much as
/// noise makes it uncertain, then the height in each channel. Masked pixels do not count. The shape stays.
/// Returns false, and leaves the star, where that ends nowhere: the star is lost.
bool fit_star(const Image& image, const PixelMask& unusable, const StarWidths& widths, PictureStar& star);

/// The sum of squares that a star of this place leaves, over the squared noise of a pixel: tells profiles
/// apart that are compared in one `window`, the pixels which a fit of that profile looks at.
double shape_misfit(const Image& image, const PixelMask& unusable, const PictureStar& star,
                    const StarProfile& window);

/// The same of a star that was taken away from the picture, if it had another profile.
double shape_misfit_of_taken(const Image& image, const PixelMask& unusable, const PictureStar& star,
                             const StarProfile& profile);

/// Adds `sign` times the star to the first three channels, out to where it is lost in the noise.
void add_star(Image& image, const PictureStar& star, float sign);

/// How far add_star reaches, px, at most widest_reach_px (saturated ones farther).
double reach_px(const PictureStar& star);
inline constexpr double widest_reach_px = 24.0;

inline constexpr double narrowest_fwhm_px = 1.2;  // of a fit: a point that one pixel averages

}  // namespace astrosplat
