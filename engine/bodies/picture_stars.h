// All stars of a picture, ordinary and bright ones. The bright are wide, saturated and with wings, so that no
// one Gaussian shows them and take_stars() leaves them: each becomes several. In: linear light. Out: the
// light without them, and their dots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bodies/picture_splats.h"
#include "bodies/placement.h"
#include "bodies/stars.h"
#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

/// Finds round bright points of a half width of 1.7 px up to 14 px (and in proportion in pictures wider than
/// 1920 px) that fall off on all sides as stars do. Takes for each up to three Gaussians of one `body` out of
/// `light`, down to 0.9 times what is around it. Their sigmas are powers of two. The same bits with any
/// number of threads.
std::vector<Star> take_bright_stars(Image& light);

struct PictureStars {
    std::vector<Star> all;     // ordinary ones, each a Gaussian; then those of bright ones; each by sigma
    std::size_t ordinary = 0;  // of `all`
    std::int64_t count = 0;    // of stars, ordinary and bright
};

/// Takes the stars out of `light`, where `params` say so. Bright ones of disks only: other kinds have no one
/// depth for what such a star leaves around itself. Where the picture was `enlarged`, a star is some texels
/// with flat light between them; only what a Gaussian explains is one then.
PictureStars take_picture_stars(Image& light, const StructureParams& params, bool enlarged = false);

/// Adds their dots.
void add_picture_stars(const PictureStars& stars, const Placement& placement, const Opacity& opacity,
                       PictureSplats& out);

}  // namespace astrosplat
