// A share of a layer that looks like the whole (DESIGN 10): fewer splats, each more opaque and, where that
// does not suffice, larger, so that alpha * radius^2 is conserved.
#pragma once

#include "splats/shaded_splats.h"

namespace astrosplat {

/// alpha' = min(max(0.5, alpha), alpha/q), radius' = radius * sqrt(alpha / (q alpha')). `share` is q in (0,
/// 1]; 1 changes nothing. `additive`: alpha/q at the same radius; what would make alpha larger than 1, where
/// the renderer cuts it, goes into the colour, whose product with alpha is all that an additive blend sees.
void decimate(ShadedSplats& splats, float share, bool additive);

}  // namespace astrosplat
