// Which bins of a pyramid splats touch, many splats at once. Takes where the splats are and how far they
// reach; gives each a rectangle of bins on one level.
#pragma once

#include "core/buffer.h"

namespace astrosplat {

/// Where splats are on the frame and how far they reach, value by value, as vector code wants them: centres
/// and reaches in px of the whole frame.
struct Discs {
    Buffer<float> x_px, y_px, reach_px;
    void resize(std::size_t size) {
        x_px.resize(size);
        y_px.resize(size);
        reach_px.resize(size);
    }
    void set(std::size_t i, float x, float y, float reach) {
        x_px[i] = x;
        y_px[i] = y;
        reach_px[i] = reach;
    }
    /// Touches nothing: fills the last vector.
    void set_nowhere(std::size_t i) { set(i, 1e30f, 1e30f, 0.0f); }
};

/// One level of a pyramid of bins; each is made of bins twice as wide as those of the level before.
struct BinLevel {
    std::uint32_t first_bin, columns;
    float last_column, last_row;
};

/// Bins over a part of the frame.
struct BinPyramid {
    float x0_px, y0_px;                // its corner in the whole frame
    float bin_px;                      // width of the bins of the first level, a multiple of 8
    std::span<const BinLevel> levels;  // the last one is a single bin
};

/// Bins first_bin + row * columns + column, with column < wide and row < high.
struct BinRect {
    std::uint32_t first_bin, columns, wide, high;
};

constexpr std::size_t most_bins = 9;       // that find_bins gives one disc
constexpr std::size_t bin_rect_room = 15;  // that it wants at the end of its arrays

/// Sets the bins that the square around each of `count` discs touches. They are of the first level whose bins
/// are at least as wide as the disc's reach, or of the last one, and three by three at most. Both arrays need
/// bin_rect_room more places, whatever is in them.
void find_bins(const BinPyramid& pyramid, const Discs& discs, std::size_t count, BinRect* rects);

}  // namespace astrosplat
