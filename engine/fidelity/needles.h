// Whether points are round seen from the side, or columns of splats stand where there should be stars. In:
// linear light of a side view in which the picture's normal is up. Out: the share of the strongest points
// that are needles.
#pragma once

#include "core/image.h"

namespace astrosplat {

struct Needles {
    int points = 0;      // measured: at most the 400 strongest
    double share = 0.0;  // of them longer than 1.6 times their width, from top to bottom; 0 without points
};

/// Points are peaks of the displayed brightest channel, blurs of 1 px minus 7 px, at least 1e-4, 12 px away
/// from the edges. The width and length of each are moments of what stands out of its surroundings within 9
/// px.
Needles needles(const Image& side_view);

/// What a flat picture has of them from 60 degrees: the upright rims in it, that no depth can make round.
Needles flat_needles(const Image& picture);

}  // namespace astrosplat
