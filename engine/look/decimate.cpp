// One pass over the splats, in place.
#include "look/decimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr std::int64_t chunk = 1 << 15;

void brighten(ShadedSplats& splats, std::size_t i, float wanted) {
    splats.alpha[i] = std::min(1.0f, wanted);
    splats.color[i] *= wanted > 1.0f ? wanted : 1.0f;
}

void thicken(ShadedSplats& splats, std::size_t i, float wanted) {
    const float alpha = std::min(std::max(0.5f, splats.alpha[i]), wanted);
    if (wanted > alpha) splats.radius[i] *= std::sqrt(wanted / alpha);
    splats.alpha[i] = alpha;
}

}  // namespace

void decimate(ShadedSplats& splats, float share, bool additive) {
    assert(share > 0.0f && share <= 1.0f);
    if (share == 1.0f) return;
    const float inverse = 1.0f / share;
    parallel_each(splats.alpha.size(), chunk, [&](std::size_t i) {
        const float wanted = splats.alpha[i] * inverse;
        additive ? brighten(splats, i, wanted) : thicken(splats, i, wanted);
    });
}

}  // namespace astrosplat
