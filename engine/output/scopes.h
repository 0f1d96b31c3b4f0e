// Scopes of a picture: how often each value is in it, in which column, and of what hue. In: the 8-bit display
// values that a screen gets. Out: counts, and these as pictures to be drawn.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/standard.h"

namespace astrosplat {

enum class Scope { histogram, waveform, vectorscope };
inline constexpr std::size_t scope_count = 3;

/// Display values, 0..255: RGBA, rows of `width` points.
struct ScreenPoints {
    std::int64_t width = 0;
    std::vector<unsigned char> rgba;
};

/// Counts in a grid whose lowest row comes first. Every point is counted once a channel.
struct ScopeCounts {
    int columns = 0, rows = 0, channels = 0;
    std::vector<std::uint32_t> counts;  // channels in columns in rows

    std::size_t index(int column, int row, int channel) const {
        return static_cast<std::size_t>((row * columns + column) * channels + channel);
    }
    std::uint32_t at(int column, int row, int channel) const { return counts[index(column, row, channel)]; }
};

/// Histogram: a column for each value of red, green and blue, in one row. Waveform: as many columns
/// of the picture, 256 at most, from its left to its right, a row for each value. Vectorscope: of one
/// channel, Cb to the right and Cr up (chroma_of), from -vector_reach to vector_reach; neutral grey is in its
/// middle.
ScopeCounts count_points(Scope scope, const ScreenPoints& points);

/// Beyond 0.5, which no colour exceeds.
inline constexpr float vector_reach = 0.55f;

/// Cb and Cr of Rec. 709, -0.5..0.5, of display values 0..1.
glm::vec2 chroma_of(glm::vec3 rgb);

/// The counts as display values on black, opaque, the highest row first: the share of the fullest value
/// between black and white under a square root as filled curves, else light that grows with the logarithm.
Image scope_picture(Scope scope, const ScopeCounts& counts);

}  // namespace astrosplat
