// Three filters as one colour picture whose bright parts keep their colour (Lupton et al. 2004, PASP 116,
// 133). In: intensities. Out: linear light of what is to be shown.
#pragma once

#include "core/image.h"

namespace astrosplat {

struct LuptonSettings {
    double q = 8.0;        // > 0: how early the stretch turns from linear to logarithmic
    double stretch = 0.1;  // > 0: intensity that is shown at about a tenth of white
};

/// r, g, b are scaled together by asinh(q I / stretch) / I of their mean I, so that a tenth of white has the
/// slope of a linear stretch, and divided by the greatest of them where that exceeds white; these are display
/// values, which are decoded to linear light. Intensities below 0 become 0. Other channels stay.
void apply_lupton(Image& image, const LuptonSettings& settings);

}  // namespace astrosplat
