// Holes of a picture filled from their surroundings. In: a picture and which of its pixels are unknown.
// Out: the picture with these pixels filled; all others keep their values.
#pragma once

#include <vector>

#include "core/buffer.h"
#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

/// Some pixels of a picture.
struct PixelMask {
    std::int64_t width = 0, height = 0;  // px
    Buffer<unsigned char> pixels;        // width * height; 1: belongs to the mask, else 0

    unsigned char& at(std::int64_t x, std::int64_t y) {
        return pixels[static_cast<std::size_t>(y * width + x)];
    }
    bool at(std::int64_t x, std::int64_t y) const {
        return pixels[static_cast<std::size_t>(y * width + x)] != 0;
    }
};

PixelMask make_mask(std::int64_t width, std::int64_t height);

/// Pixels of a mask that touch each other, sides or corners.
struct Hole {
    Region box;                        // the smallest that holds them all
    std::vector<std::int64_t> pixels;  // y * width + x, ascending
};

/// All connected parts, in the order of their first pixels.
std::vector<Hole> connected_parts(const PixelMask& mask);

enum class FillKind { membrane, texture };

/// Fills the masked pixels of every channel. membrane: the smooth surface through the hole's rim (Laplace's
/// equation). texture: that surface plus what stands out of it in an equally large piece beside the hole, the
/// one that fits the rim best; the membrane where there is no such piece. A picture that is one hole becomes
/// 0. Time and memory grow with the holes' boxes. The same bits with any number of threads. Throws Cancelled.
void fill(Image& image, const PixelMask& holes, FillKind kind, const Progress& progress = {});

}  // namespace astrosplat
