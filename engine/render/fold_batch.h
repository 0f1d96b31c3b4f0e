// What the fold knows of the splats it is about to fold: up to 64 at a time, in total order, value by value.
#pragma once

#include <cstdint>

#include "render/fold.h"
#include "render/footprint.h"

namespace astrosplat {

struct SplatBatch {
    static constexpr int size = 64;
    static constexpr int blocks = TilePlanes::cell_blocks * TilePlanes::cell_blocks;
    int count = 0;
    const ScreenSplat* splat[size];
    std::uint16_t layer[size];
    std::uint8_t linear_in_distance[size];  // as in FootprintTable
    std::uint8_t
        bright[size];  // a screen splat with a channel above 1: alpha is the mean of the clamped ones
    alignas(64) std::uint64_t touches[blocks];  // bit i: splat i may have weight in the block

    // Of the whole picture; places beyond `count` have a reach below 0.
    alignas(64) float x_px[size];
    alignas(64) float y_px[size];
    alignas(64) float reach_squared[size];

    // The weight, as in Footprint.
    alignas(64) float cubic[size][4][FootprintNode::segments];  // [splat][power][segment]
    alignas(64) float lo[size];
    alignas(64) float scale[size];
    alignas(64) float edge_gain[size];
    alignas(64) float weight_gain[size];  // amplitude alone, for coverage

    alignas(64) float opacity[size];       // times the footprint's amplitude
    alignas(64) float color[3][size];      // 0 for holdouts
    alignas(64) float occlusion[4][size];  // o per channel; [3] for alpha
    alignas(64) float shows[size];         // 0 for holdouts
    alignas(64) float depth[size];         // scene units along the view axis

    // What the weights are made of, while they are prepared.
    alignas(64) float radius_px[size];
    alignas(64) float alpha[size];     // opacity as the splat has it
    alignas(64) float cosine_x[size];  // phase of the centre relative to the pixels
    alignas(64) float cosine_y[size];
    alignas(64) float tabulated[size];      // 1; 0 for radii beyond the table
    alignas(64) float moments[3][size][4];  // of FootprintMoments, four by four
};

}  // namespace astrosplat
