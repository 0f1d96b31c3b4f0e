// Views from the side, where a picture's depth is seen: the profile of a disk from its edge, of which numbers
// are known of real galaxies, and whether points are round, or columns of splats stand where there should be
// stars. In: linear light of a view in which the picture's normal is up. Out: numbers.
#pragma once

#include "core/image.h"

namespace astrosplat {

struct EdgeOnProfile {
    double fwhm_over_length =
        0.0;                // full width at half maximum of the light's profile, over the disk's length
    double dust_dip = 0.0;  // depth of the dust lane in that profile, 0..1; 0 for disks thinner than 7 px
    double center_over_half = 0.0;  // brightness of the centre over that at half the radius
    double body_srgb = 0.0;         // mean of the body, as displayed, 0..1
};

/// Of the brightest channel. The disk is as long as its columns are brighter than 15 % of the brightest.
/// All 0 where the picture is black.
EdgeOnProfile edge_on_profile(const Image& edge_view);

struct Needles {
    int points = 0;      // measured: at most the 400 strongest
    double share = 0.0;  // of them longer than 1.6 times their width, from top to bottom; 0 without points
};

/// Points are peaks of the displayed brightest channel, blurs of 1 px minus 7 px, at least 1e-4, 12 px away
/// from the edges. The width and length of each are moments of what stands out of its surroundings
/// within 9 px.
Needles needles(const Image& side_view);

/// Structure that a view 45 degrees off has and the front has not: the largest ratio, over octaves of 2 to 32
/// px, of local contrast along x, the axis that the tilt does not shorten, where it is lit. Both about 800 px
/// wide. 1: none, above 1.15 smooth light has become spots. 0 where there is no light.
double mottle(const Image& front, const Image& tilted);

/// A galaxy seen along its normal.
struct DiskFromAbove {
    double roundness = 0.0;  // minor over major axis of its isophotes, mean of three: 1 is round
    double grain = 0.0;  // detail of 4 px long along y over that along x, where y is the picture's line of
                         // sight: 1 is neither
};

/// About 800 px wide. All 0 where it is black.
DiskFromAbove disk_from_above(const Image& above);

/// Needles that a flat picture has from 60 degrees: the upright rims in it, that no depth can make round.
Needles flat_needles(const Image& picture);

}  // namespace astrosplat
