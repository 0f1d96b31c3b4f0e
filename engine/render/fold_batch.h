// What the fold knows of the splats it is about to fold: up to 64 at a time, in total order, all that the
// blocks of a cell ask of them side by side.
#pragma once

#include <cstdint>

#include "render/fold.h"
#include "render/footprint.h"

namespace astrosplat {

/// One splat, ready to be folded: five cache lines.
struct alignas(64) PreparedSplat {
    float cubic[4][FootprintNode::segments];  // of the weight, [power][segment]
    float x_px, y_px;                         // of the whole picture
    float lo, scale;                          // as in Footprint
    float edge_gain;
    float opacity;       // times the footprint's amplitude
    float weight_gain;   // amplitude alone, for coverage
    float color[3];      // 0 for holdouts
    float occlusion[4];  // o per channel; [3] for alpha
    float shows;         // 0 for holdouts
    float depth;         // scene units along the view axis
};
static_assert(sizeof(PreparedSplat) == 320);

struct SplatBatch {
    static constexpr int size = 64;
    static constexpr int blocks = TilePlanes::cell_blocks * TilePlanes::cell_blocks;
    PreparedSplat splats[size];
    std::uint8_t linear_in_distance[size];  // as in FootprintTable
    std::uint8_t
        bright_screen[size];  // a colour above 1 under screen: alpha is the mean of the clamped channels
    std::uint16_t layer[size];
    alignas(64) std::uint64_t touches[blocks];  // bit i: splat i may have weight in the block

    // Gathered first, for the test against the blocks; places beyond `count` have a reach below 0.
    int count = 0;
    std::uint32_t index[size];
    alignas(64) float x_px[size], y_px[size], reach_squared[size];
};

}  // namespace astrosplat
