// match = "picture": a front view shows the light of the picture, whichever of its positions became splats
// and however wide they are. In: a set and its look, a chart and the sums of its cells. Out: factors of alpha
// and colour for each splat that is kept.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "look/kernel.h"
#include "look/picture_chart.h"
#include "splats/shaded_splats.h"

namespace astrosplat {

/// The layer's falloff as seen from afar.
struct FalloffMoments {
    double integral = 1.0;  // over the unit disc
    double variance = 0.1;  // along an axis, square radii
};

struct PictureFactors {
    std::vector<std::uint32_t>
        cell_of;            // of each splat that shade_run keeps, in order of the set, or beyond_cells
    ChannelValues of_cell;  // of alpha, and of alpha * color
};

/// picture_chart, picture_cells and picture_fit. Empty for a set without u and v. Reads the set before its
/// arrays are written over. The same bits with any number of threads. Throws InputError for want of memory.
PictureFactors picture_factors(const LookRun& run, const SplatSet& set, const FalloffMoments& falloff);

/// Multiplies; alphas end at 1.
void apply_factors(const PictureFactors& factors, ShadedSplats& shaded);

}  // namespace astrosplat
