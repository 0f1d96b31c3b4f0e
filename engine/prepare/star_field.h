// All stars of a picture. In: linear light. Out: a list of stars, and the picture less their profiles.
#pragma once

#include <limits>
#include <vector>

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

}  // namespace astrosplat
