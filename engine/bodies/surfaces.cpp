#include "bodies/surfaces.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bodies/fields.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "core/sorting.h"
#include "image/blur.h"

namespace astrosplat {
namespace {

// Found on the Crab and the Ring: the walls follow the outline of what is bright over wide areas.
constexpr std::int64_t longest_grid = 128;         // px, on which the equation is solved
constexpr double silhouette_blur = 20.0 / 1920.0;  // of the width
constexpr double sky_percentile = 0.02, bright_percentile = 0.96;
constexpr double silhouette_from = 0.04, silhouette_to = 0.13;  // of the range between them: its soft edge
constexpr float leak = 4.0f;                                    // outside of it, by which h falls off
constexpr int sweeps = 400;

}  // namespace

SilhouetteGrid silhouette_grid(const Image& brightest) {
    SilhouetteGrid grid{brightest, {}};
    for (int i = 0; i < field_halvings(brightest); ++i) grid.light = halved(grid.light);
    grid.light = gaussian_blur(grid.light, silhouette_blur * static_cast<double>(grid.light.width));
    while (std::max(grid.light.width, grid.light.height) > longest_grid) {
        grid.finer.push_back({grid.light.width, grid.light.height});
        grid.light = halved(grid.light);
    }
    return grid;
}

Image silhouette_of(Image light) {
    const std::vector<double> values{light.pixels.begin(), light.pixels.end()};
    const double sky = percentile(values, sky_percentile);
    const double range = std::max(1e-12, percentile(values, bright_percentile) - sky);
    for (float& value : light.pixels) {
        const double share = (static_cast<double>(value) - sky) / range;
        const double t = std::clamp((share - silhouette_from) / (silhouette_to - silhouette_from), 0.0, 1.0);
        value = static_cast<float>(real::smoothstep(t));
    }
    return light;
}

Image to_field_size(Image coarse, const SilhouetteGrid& grid) {
    for (auto size = grid.finer.rbegin(); size != grid.finer.rend(); ++size)
        coarse = doubled(coarse, size->width, size->height);
    return coarse;
}

// Successive over-relaxation, in order of rows: one thread, so that the bits are the same. 0 beyond the
// edges.
Image blown_up(const Image& silhouette) {
    const auto longest = static_cast<float>(std::max(silhouette.width, silhouette.height));
    const float relaxation = 2.0f / (1.0f + 3.14159265f / longest);
    Image h = make_image(silhouette.width, silhouette.height, 1);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (std::int64_t y = 0; y < h.height; ++y) {
            for (std::int64_t x = 0; x < h.width; ++x) {
                const float left = x > 0 ? *h.at(x - 1, y) : 0.0f;
                const float right = x + 1 < h.width ? *h.at(x + 1, y) : 0.0f;
                const float up = y > 0 ? *h.at(x, y - 1) : 0.0f;
                const float down = y + 1 < h.height ? *h.at(x, y + 1) : 0.0f;
                const float inside = *silhouette.at(x, y);
                const float level = (left + right + up + down + inside) / (4.0f + leak * (1.0f - inside));
                float& here = *h.at(x, y);
                here += relaxation * (level - here);
            }
        }
    }
    return h;
}

Image shell_field(const Image& brightest, double depth, double steepest) {
    SilhouetteGrid grid = silhouette_grid(brightest);
    Image shell = blown_up(silhouette_of(grid.light));
    const float highest = *std::max_element(shell.pixels.begin(), shell.pixels.end());
    if (highest > 0.0f)
        for (float& value : shell.pixels)
            value = static_cast<float>(depth) * std::sqrt(std::max(0.0f, value) / highest);
    shell = to_field_size(std::move(shell), grid);
    if (highest <= 0.0f) return shell;
    limit_slope(shell, steepest * static_cast<double>(1 << field_halvings(brightest)));
    return gaussian_blur(shell, 0.005 * static_cast<double>(shell.width));  // takes corners off
}

namespace {

using shared::as_hash, shared::as_mix, shared::as_uniform;

constexpr float side_sharpness = 8.0f;  // of the change from one wall to the other
constexpr float least_side = 0.15f;  // share of a filament's dots on the other one: no part of a wall is bare

float sheet_at(const Placement& placement, float x, float y) {
    return 2.0f * placement.relief_at(x, y) - static_cast<float>(placement.depth);
}

// -1..1 of any value.
float between(float value) { return 2.0f / (1.0f + shared::as_exp(-2.0f * value)) - 1.0f; }

// Depths within the reach of each column, which is its height here: all are as likely, and they gather in
// clouds as a disk's do.
void spread_in_clouds(const Placement& placement, double feature, DepthBlock& block) {
    std::fill_n(block.clumping, block.count, 1.0f);
    disk_depths(stack(placement, placement.depth, feature, clump_gain(placement, feature), 0.75), block);
    for (int i = 0; i < block.count; ++i)  // sech^2 becomes even
        block.z[i] =
            block.height[i] * (1.0f - 2.0f / (1.0f + shared::as_exp(2.0f * block.z[i] / block.height[i])));
}

// Those of the sky that belong to no knot.
void spread_in_sky(const Placement& placement, double feature, const DepthReach* reaches,
                   PlacedBlock& block) {
    DepthBlock sky;
    int dots[PlacedBlock::size];
    sky.count = 0;
    for (int i = 0; i < block.count; ++i) {
        if (reaches[i].of != DepthReach::Of::sky || block.knot[i] >= 0) continue;
        dots[sky.count] = i;
        sky.x[sky.count] = block.x[i];
        sky.y[sky.count] = block.y[i];
        sky.random[sky.count] = block.random[i];
        sky.height[sky.count++] = reaches[i].texels;
    }
    if (sky.count == 0) return;
    spread_in_clouds(placement, feature, sky);
    for (int k = 0; k < sky.count; ++k) block.z[dots[k]] = sky.z[k];
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

void add_walls(const Placement& placement, double feature, PlacedBlock& block) {
    DepthBlock side = block;
    for (int i = 0; i < block.count; ++i) {
        if (block.knot[i] < 0) continue;
        const Knot& knot = placement.knots.knots[static_cast<std::size_t>(block.knot[i])];
        side.x[i] = knot.x;
        side.y[i] = knot.y;
    }
    DepthBlock bend = side, within = side;
    const double unit = 0.26 * placement.depth;
    noise_sum(waves(placement, 1, {{220.0, 1.0}, {90.0, 0.6}}), side);
    noise_sum(waves(placement, 2, {{520.0, 0.22 * unit}, {210.0, 0.07 * unit}}), bend);
    noise_sum(waves(placement, 3, {{640.0, 1.0}, {260.0, 0.3}}), within);
    DepthReach reaches[PlacedBlock::size];
    for (int i = 0; i < block.count; ++i) {
        const float front =
            least_side + (1.0f - 2.0f * least_side) / (1.0f + shared::as_exp(-side_sharpness * side.z[i]));
        const std::uint32_t random = block.knot[i] < 0
                                         ? block.random[i]
                                         : as_hash(placement.seed, static_cast<std::uint32_t>(block.knot[i]),
                                                   1u, shared::PURPOSE_KNOT);
        const bool in_front = as_uniform(as_mix(random ^ 0x5bd1e995u)) < front;
        const float anywhere = 2.0f * as_uniform(as_mix(random ^ 0x27d4eb2fu)) - 1.0f;
        reaches[i] = placement.reach_at(bend.x[i], bend.y[i], random, false);
        const float at = reaches[i].of == DepthReach::Of::walls  ? (in_front ? 1.0f : -1.0f)
                         : reaches[i].of == DepthReach::Of::core ? between(within.z[i])
                                                                 : anywhere;
        block.z[i] += at * reaches[i].texels + bend.z[i];
    }
    spread_in_sky(placement, feature, reaches, block);
}

void fill_between_walls(const Placement& placement, double feature, PlacedBlock& block) {
    for (int i = 0; i < block.count; ++i)
        block.height[i] = std::max(block.height[i],
                                   placement.reach_at(block.x[i], block.y[i], block.random[i], true).texels);
    spread_in_clouds(placement, feature, block);
}

}  // namespace astrosplat
