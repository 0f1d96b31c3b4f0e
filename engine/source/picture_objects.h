// What stands out of a picture of the deep sky: its galaxies and stars, each for itself, and the sky between
// them. In: linear light. Out: the objects with their pixels, and the picture without.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "core/image.h"

namespace astrosplat {

struct PictureObject {
    glm::vec2 middle{0.0f};  // of its light, px from the top left corner
    float reach = 0.0f;      // px from there to its farthest pixel
};

struct PictureObjects {
    std::vector<PictureObject> objects;
    std::vector<std::int32_t> owner;  // of each pixel: an object's number, -1 for none
    Image light;                      // RGB: what the objects add
    Image sky;                        // RGB: the rest; together they are the picture
};

/// Objects are connected pixels brighter than the median by 2.5 standard deviations of the sky, and 2 px
/// around them; what reaches farther than `longest_px` from its middle stays in the sky.
PictureObjects find_objects(const Image& picture, double longest_px);

}  // namespace astrosplat
