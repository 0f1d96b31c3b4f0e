// Where a picture is brighter or darker than another, for eyes. In: both as linear light of one size. Out: a
// picture of display values.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// Difference of displayed values that is shown in full colour, of white.
inline constexpr double full_difference = 0.1;

/// Displayed value a minus b, mean of the channels, as RGBA with alpha 1: orange where a is brighter, blue
/// where it is darker, nearly black where they are equal.
Image signed_difference(const Image& a, const Image& b);

}  // namespace astrosplat
