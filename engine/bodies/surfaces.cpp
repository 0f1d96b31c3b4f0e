#include "bodies/surfaces.h"

#include <algorithm>

#include "bodies/octaves.h"
#include "core/shared_maths.h"

namespace astrosplat {
namespace {

using shared::as_hash, shared::as_mix, shared::as_uniform;

constexpr float side_sharpness = 8.0f;  // of the change from one wall to the other
constexpr float least_side = 0.15f;  // share of a filament's dots on the other one: no part of a wall is bare

float sheet_at(const Placement& placement, float x, float y) {
    return 2.0f * placement.relief_at(x, y) - static_cast<float>(placement.depth);
}

}  // namespace

void add_relief(const Placement& placement, PlacedBlock& block) {
    if (placement.relief.pixels.empty()) return;
    for (int i = 0; i < block.count; ++i) {
        const float own = sheet_at(placement, block.x[i], block.y[i]);
        if (block.knot[i] < 0) {
            block.z[i] += own;
        } else {
            const Knot& knot = placement.knots.knots[static_cast<std::size_t>(block.knot[i])];
            block.z[i] += own + knot.roundness * (sheet_at(placement, knot.x, knot.y) - own);
        }
    }
}

void add_walls(const Placement& placement, PlacedBlock& block) {
    DepthBlock side = block;
    for (int i = 0; i < block.count; ++i) {
        if (block.knot[i] < 0) continue;
        const Knot& knot = placement.knots.knots[static_cast<std::size_t>(block.knot[i])];
        side.x[i] = knot.x;
        side.y[i] = knot.y;
    }
    DepthBlock bend = side;
    const double unit = 0.26 * placement.depth;
    noise_sum(waves(placement, 1, {{220.0, 1.0}, {90.0, 0.6}}), side);
    noise_sum(waves(placement, 2, {{520.0, 0.22 * unit}, {210.0, 0.07 * unit}}), bend);
    for (int i = 0; i < block.count; ++i) {
        const float front =
            least_side + (1.0f - 2.0f * least_side) / (1.0f + shared::as_exp(-side_sharpness * side.z[i]));
        const std::uint32_t random = block.knot[i] < 0
                                         ? block.random[i]
                                         : as_hash(placement.seed, static_cast<std::uint32_t>(block.knot[i]),
                                                   1u, shared::PURPOSE_KNOT);
        const bool in_front = as_uniform(as_mix(random ^ 0x5bd1e995u)) < front;
        const float out = placement.relief_at(bend.x[i], bend.y[i]);
        block.z[i] += (in_front ? out : -out) + bend.z[i];
    }
}

void fill_between_walls(const Placement& placement, double feature, PlacedBlock& block) {
    float reach[PlacedBlock::size];
    for (int i = 0; i < block.count; ++i) {
        reach[i] = std::max(block.height[i], placement.relief_at(block.x[i], block.y[i]));
        block.height[i] = reach[i];
        block.clumping[i] = 1.0f;
    }
    const double gain = clump_gain(placement, feature);
    disk_depths(stack(placement, placement.depth, feature, gain, 0.75), block);
    for (int i = 0; i < block.count; ++i)  // sech^2 becomes even
        block.z[i] = reach[i] * (1.0f - 2.0f / (1.0f + shared::as_exp(2.0f * block.z[i] / reach[i])));
}

}  // namespace astrosplat
