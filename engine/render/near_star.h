// Stars of pictures that the camera comes near. A star has no size that one could see: its dot is the
// telescope's blur, and would be a blurred disc close by. In: how near it is. Out: how its image grows.
#pragma once

#include <algorithm>
#include <cmath>

namespace astrosplat {

/// The most that such a star's colour is multiplied by.
inline constexpr float brightest_near_star = 16.0f;

/// Radius of the image of a star at a share `nearness`, in (0, 1), of lod.star_distance, over that of a dot
/// there. From that distance on the image grows only with the fourth root of 1 / nearness, as a brighter star
/// in a photograph is a little larger, until its light, which is the dot's, is brightest_near_star times as
/// dense. 1 where nearness is 1.
inline float near_star_size(float nearness) {
    const float root = std::sqrt(nearness);
    return std::max(1.0f / std::sqrt(brightest_near_star), root * std::sqrt(root));
}

}  // namespace astrosplat
