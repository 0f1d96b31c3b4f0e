// What the splats of each small cell of a picture show, and what they should. In: a set, its look and a
// chart. Out: sums over the positions of a cell, and the cell of every position that became a splat.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "look/chart_blur.h"
#include "look/kernel.h"
#include "look/picture_chart.h"

namespace astrosplat {

/// Opacity, and light in red, green and blue.
inline constexpr std::size_t picture_channels = 4;
using ChannelValues = std::array<CellValues, picture_channels>;

/// In place of a cell: not a splat; one beyond an edge of the picture, whose light is no cell's.
inline constexpr std::uint32_t no_cell = 0xffffffffu, beyond_cells = 0xfffffffeu;

/// Sums over the positions of a block.
struct CoverSums {
    double due = 0.0;  // the column's mean of optical depth that each stands for, of a depth of 1, in cells
    double unclamped = 0.0;  // how many there are in `due`; the others are as opaque as can be
};

/// Sums over the positions of each cell, or where it says so over those of them that became splats.
struct PictureCells {
    ChannelValues depth;   // of splats: alpha * color (of opacity: 1) * the area of the footprint in cells
    CellValues squares;    // of splats: the square of that of opacity
    ChannelValues wanted;  // what a front view shows where all is of the position's colour and alpha
    CellValues positions;  // how many there are
    /// Expected depth as the look's noise and crops leave it, and without them. Empty where it has none.
    CellValues varied, plain;
    std::vector<CoverSums> cover;        // of each block
    std::vector<std::uint32_t> cell_of;  // of each position, or one of the two above
};

/// Memory that a chart's sums take, bytes.
std::int64_t picture_cells_bytes(const PictureChart& chart, std::int64_t positions);

/// The same bits with any number of threads.
PictureCells picture_cells(const LookRun& run, const SplatSet& set, const PictureChart& chart,
                           double falloff_integral);

}  // namespace astrosplat
