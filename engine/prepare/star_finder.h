// Points that stand out of a picture. In: brightness. Out: where a star may be, and how uncertain its height
// is there.
#pragma once

#include <vector>

#include "core/image.h"
#include "prepare/cells.h"

namespace astrosplat {

/// What a star of a given width would be at every pixel: the height of a Gaussian with a constant background
/// under it, by least squares in a square around the pixel (DAOFIND; Stetson 1987, PASP 99, 191).
/// `brightness` has one channel, and so has the result.
Image matched_heights(const Image& brightness, double sigma_px);

/// For white noise.
double pixel_noise_over_height_noise(double sigma_px);

/// How far these heights scatter where there is no star, by cells, and not below `least`.
Cells noise_of_heights(const Image& heights, double least);

struct StarCandidate {
    double x, y;    // px from the top left corner
    double height;  // of matched_heights
    double noise;
};

/// The greatest of 5x5 heights above `threshold` times their noise, in order of rows.
std::vector<StarCandidate> find_candidates(const Image& heights, const Cells& noise, double threshold);

/// The mean of the first three channels.
Image mean_of_channels(const Image& image);

}  // namespace astrosplat
