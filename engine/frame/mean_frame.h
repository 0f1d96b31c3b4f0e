// The mean of several renderings of one frame: motion blur and depth of field. In: rendered frames, one after
// the other. Out: one.
#pragma once

#include <cstddef>
#include <span>

#include "render/frame.h"

namespace astrosplat {

/// Adds a rendering to the sum of those before it; an empty sum becomes the rendering. `layers`: which of the
/// frame's layers each of the rendering's is; the sum has images of those that came so far, empty ones of the
/// others. Depths are weighted by RenderedFrame::opacity, which has to be there with them.
void add_rendering(RenderedFrame& sum, RenderedFrame&& rendering, std::span<const std::size_t> layers);

/// Makes the sum of n renderings their mean, with an image for each of `layer_count` layers (0: none). Of the
/// statistics, counts and overlap are means and seconds a sum.
void divide_sum(RenderedFrame& sum, int n, std::size_t layer_count);

}  // namespace astrosplat
