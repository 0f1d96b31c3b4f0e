// A picture without its stars. In: linear light. Out: the same picture with its surroundings continued where
// stars were, and the stars as a list. Whatever is in one is not in the other.
#pragma once

#include "prepare/star_field.h"

namespace astrosplat {

struct StarRemoval {
    Image starless;                  // channels as the picture's; those behind the third are unchanged
    std::vector<PictureStar> stars;  // the brightest (by flux of all channels) first
};

/// Takes the stars of the first three channels away. Where a star stood far above the noise, its profile is
/// not trusted to leave the noise alone: the pixels are filled from around it. No pixel falls below 0 that
/// did not before. The same bits with any number of threads. Throws Cancelled.
StarRemoval remove_stars(const Image& image, const StarSettings& settings, const Progress& progress = {});

/// Bytes that it takes at its peak beside the picture.
std::int64_t star_removal_bytes(const Image& image);

}  // namespace astrosplat
