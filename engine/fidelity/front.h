// A front view against the picture it is made of: how alike they look, whether there is as much light, in all
// and place by place, and as much detail of every size. In: both as linear light on black, of one size.
// Out: numbers.
#pragma once

#include <cmath>

#include "core/image.h"
#include "fidelity/display.h"

namespace astrosplat {

/// Peak signal to noise ratio of the displayed channels, dB: 10 log10(1 / mean square error), at most 120.
double psnr_db(const Image& a, const Image& b);

/// Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) of the displayed channels' mean: Gaussian
/// window of 1.5 px, constants .01^2 and .03^2, mean over all pixels; 1 for equal images.
double ssim(const Image& a, const Image& b);

/// Cells along either side of the grid that an image is divided into.
inline constexpr std::int64_t flux_cells = 32;
/// A cell of the reference darker than this, as the mean of its channels (1: white), holds no light to
/// compare with.
inline constexpr double darkest_cell = 0.002;

struct FluxRatios {
    std::array<double, 3> channels{};  // light of the view over light of the reference: red, green, blue
    double frame = 0.0;                // of all three
    std::vector<double> cells;         // flux_cells^2 from the top left; NaN where the reference is dark
    double cells_5 = 0.0, cells_50 = 0.0,
           cells_95 = 0.0;  // percentiles of the lit cells; 0 where none is lit
};

/// NaN where the reference has no light.
FluxRatios flux_ratios(const Image& view, const Image& reference);

/// Detail between two sizes: the difference of an image's Gaussian blurs of standard deviations finer
/// and coarser.
struct ScalePower {
    double finer_px = 0.0, coarser_px = 0.0;  // 0: the image itself
    double ratio = 0.0;                       // mean square of the view's band over that of the reference's
};

/// Bands 0 to 1, 1 to 2, 2 to 4 ... px up to an eighth of the shorter side, of the displayed channels'
/// mean. NaN where the reference has no detail of a size.
std::vector<ScalePower> power_by_scale(const Image& view, const Image& reference);

struct FrontFidelity {
    std::int64_t width_px = 0, height_px = 0;  // of the whole view
    double psnr_db = 0.0, ssim = 0.0;
    FluxRatios flux;
    ColorDifferences ciede2000;
    std::vector<ScalePower> power;
};

/// Targets for the front view of a good film of a galaxy or a nebula.
struct FrontTargets {
    double psnr_db, ssim;
};
inline constexpr FrontTargets small_targets{39.0, 0.98};  // at 1280 px
inline constexpr double most_light_off = 0.005;           // of the light of the whole frame

inline bool meets(const FrontFidelity& front, const FrontTargets& targets) {
    return front.psnr_db >= targets.psnr_db && front.ssim >= targets.ssim &&
           std::fabs(front.flux.frame - 1.0) <= most_light_off;
}

/// `border`: share of the width that is left out along every edge, 0 to below 1/2.
FrontFidelity front_fidelity(const Image& rendered, const Image& reference, double border = 0.0);

/// Bytes that it takes at its peak, about, besides the two images.
std::int64_t front_fidelity_bytes(std::int64_t width_px, std::int64_t height_px);

}  // namespace astrosplat
