// The profile of a disk seen from its edge, its normal up. In: linear light of that view. Out: numbers that
// are known of real galaxies.
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

}  // namespace astrosplat
