// The bright stars of a picture: wide, saturated and with wings, so that no one Gaussian shows them and
// take_stars() leaves them. In: linear light. Out: several Gaussians for each, and the picture without.
#pragma once

#include <vector>

#include "bodies/stars.h"
#include "core/image.h"

namespace astrosplat {

/// Finds round bright points of a half width of 1.7 px up to 14 px (and in proportion in pictures wider than
/// 1920 px) that fall off on all sides as stars do. Takes for each up to three Gaussians of one `body` out of
/// `light`, down to 0.9 times what is around it. Their sigmas are powers of two. The same bits with any
/// number of threads.
std::vector<Star> take_bright_stars(Image& light);

}  // namespace astrosplat
