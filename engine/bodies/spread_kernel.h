// Light of dots spread over the pixels about them, by quadratic B-splines. In: dots of one size. Out: rows of
// pixels. Compiled once per instruction set with the same bits on each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "core/image.h"

namespace astrosplat {

/// Rows of a grid while light is added to them. Pixels have four channels, so that each is stored and loaded
/// as one vector; and there are more of them all around, for what dots at the edges spread.
struct SpreadRows {
    static constexpr std::int64_t margin = 2;
    std::int64_t width, first, end;  // px; rows [first, end)
    Image pixels;

    SpreadRows(std::int64_t grid_width, std::int64_t first_row, std::int64_t end_row);
    /// Beyond its edges a picture is mirrored.
    void add_to(Image& sum) const;
};

/// Dots in the space of their picture, whose top left corner is at (-left, top).
struct SpreadDots {
    const glm::vec3* position;
    const glm::vec3* color;
    const float* alpha;
    std::size_t count;
    float left, top;  // texels
    float scale;      // pixels a texel
    float flux;       // pixels: the sum of the weights of a dot
};

/// Adds the light of dots, as far as it reaches the rows.
void spread_dots(const SpreadDots& dots, SpreadRows& rows);

}  // namespace astrosplat
