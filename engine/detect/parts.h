// Some pixels of a picture, which of them touch each other, and the objects of a picture of the deep sky: its
// galaxies and stars, each for itself, and the sky between them. In: a mask; linear light. Out: its connected
// parts; objects with their pixels, and the picture without.
#pragma once

#include <glm/vec2.hpp>

#include "core/buffer.h"
#include "core/image.h"

namespace astrosplat {

/// Some pixels of a picture.
struct PixelMask {
    std::int64_t width = 0, height = 0;  // px
    Buffer<unsigned char> pixels;        // width * height; 1: belongs to the mask, else 0

    unsigned char& at(std::int64_t x, std::int64_t y) { return pixels[y * width + x]; }
    bool at(std::int64_t x, std::int64_t y) const { return pixels[y * width + x] != 0; }
};

PixelMask make_mask(std::int64_t width, std::int64_t height);

/// Pixels of a mask that touch each other.
struct PixelPart {
    Region box;                        // the smallest that holds them all
    std::vector<std::int64_t> pixels;  // y * width + x, from the first one outwards
};

/// The neighbours that touch a pixel: by its sides, or by its corners too.
enum class Touching { sides, corners };

/// Takes what is connected with a pixel of the mask out of it.
PixelPart take_part(PixelMask& mask, std::int64_t first, Touching touching = Touching::corners);

/// All connected parts, in the order of their first pixels by rows.
std::vector<PixelPart> connected_parts(PixelMask mask, Touching touching = Touching::corners);

/// The mask and all pixels that touch it by side or corner.
PixelMask grown(const PixelMask& mask);

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
