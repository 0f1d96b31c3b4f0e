// The mean of several renderings of one frame: motion blur and depth of field. In: rendered frames, one after
// the other. Out: one.
#pragma once

#include "render/frame.h"

namespace astrosplat {

/// Adds a rendering to the sum of those before it; the first one becomes the sum. Depths are weighted by
/// alpha.
void add_rendering(RenderedFrame& sum, RenderedFrame&& rendering);

/// Makes the sum of n renderings their mean.
void divide_sum(RenderedFrame& sum, int n);

}  // namespace astrosplat
