#include "bodies/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "bodies/margin.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

using shared::as_hash, shared::as_mix, shared::as_uniform;

constexpr double steepest_wall = 0.8, steepest_relief = 0.6;  // DEPTH 4 has .7 and 1.2; a relief counts twice
constexpr float sky_reach = 0.8f;                             // around a shell, of its greatest

// Of a place, from the middle of the picture, in halves of its longest side.
glm::vec2 from_middle(const Placement& placement, float x, float y) {
    const auto w = float(placement.picture_width), h = float(placement.picture_height);
    return glm::vec2(x - 0.5f * w, y - 0.5f * h) * (2.0f / std::max(w, h));
}

float flare_at(const Placement& placement, float x, float y) {
    const glm::vec2 p = from_middle(placement, x, y);
    return 1.0f + float(placement.flare) * (p.x * p.x + p.y * p.y);
}

// Of a field of the picture's, at a place of the picture.
float value_at(const Placement& placement, const Image& field, float x, float y) {
    const float share = 1.0f / float(1 << placement.field_halvings);
    return bilinear(field, 0, x * share, y * share);
}

// How deep the sky around a shell is, of its greatest: like a cushion, or the picture's straight edges would
// be seen from aslant as those of a slab.
float sky_cushion(const Placement& placement, float x, float y) {
    constexpr float thinnest = 0.15f;
    const float u = 2.0f * x / float(placement.picture_width) - 1.0f,
                v = 2.0f * y / float(placement.picture_height) - 1.0f;
    return std::max(thinnest, std::sqrt(std::max(0.0f, 1.0f - u * u * u * u - v * v * v * v)));
}

// The surroundings of stars that are theirs, by their bodies.
std::vector<Knot> around_stars(std::span<const Star> stars) {
    constexpr float sigmas = 2.0f, wider_px = 3.0f, knot_reach = 3.0f;
    std::vector<Knot> knots;
    for (const Star& star : stars) {
        if (star.body >= knots.size()) knots.resize(star.body + 1);
        Knot& knot = knots[star.body];
        knot.x = star.x;
        knot.y = star.y;
        knot.sigma = std::max(knot.sigma, (sigmas * star.sigma + wider_px) / knot_reach);
    }
    return knots;
}

// Those of splats of the second finest band, and of stars their own.
void set_knot_depths(Placement& placement, std::span<const Star> stars) {
    BandSplats like;
    like.index = 1;
    like.sigma = like.spacing = 1.0f;
    like.feature = float(4.0 * placement.scale);
    const auto count = std::int64_t(placement.knots.knots.size());
    placement.knot_z.resize(std::size_t(count));
    parallel_chunks(count, DepthBlock::size, [&](std::int64_t begin, std::int64_t end, int) {
        PlacedBlock block;
        block.count = int(end - begin);
        for (int i = 0; i < block.count; ++i) {
            const Knot& knot = placement.knots.knots[begin + i];
            block.x[i] = knot.x;
            block.y[i] = knot.y;
            block.random[i] = as_hash(placement.seed, std::uint32_t(begin + i), 0u, shared::PURPOSE_KNOT);
        }
        place_freely(placement, like, block);
        std::copy_n(block.z, block.count, placement.knot_z.data() + begin);
    });
    for (const Star& star : stars)
        placement.knot_z[star.body] = star_height(placement, star) + middle_plane(placement, star.x, star.y);
}

void flare_out(Placement& placement) {
    const auto step = float(1 << placement.field_halvings);
    for_each_pixel(placement.thickness, [&](std::int64_t x, std::int64_t y) {
        *placement.thickness.at(x, y) *=
            flare_at(placement, (float(x) + 0.5f) * step, (float(y) + 0.5f) * step);
    });
}

}  // namespace

Placement placement_without_fields(std::int64_t width, std::int64_t height, const StructureParams& params,
                                   double texels_per_unit) {
    const double share = params.kind == StructureKind::disk ? disk_thickness : sheet_thickness;
    Placement placement;
    placement.kind = params.kind;
    placement.picture_width = width;
    placement.picture_height = height;
    const double width_without_margin = double(width) / (1.0 + 2.0 * params.margin);
    placement.scale = width_without_margin / 1920.0;
    const double longest_of_picture =
        std::max(width_without_margin, double(height) - 2.0 * params.margin * width_without_margin);
    // A disk that goes on is a larger disk, and so a thicker one: half of its margin is lit.
    const double longest =
        (params.kind == StructureKind::disk ? 1.0 + params.margin : 1.0) * longest_of_picture;
    placement.height = params.height > 0.0 ? params.height * texels_per_unit : share * longest;
    placement.depth = 0.5 * params.depth * width_without_margin;
    placement.clumps = params.clumps;
    return placement;
}

Placement make_placement(const Image& brightest, const StructureParams& params, double texels_per_unit,
                         bool flat, std::uint32_t seed, std::span<const Star> stars) {
    Placement placement =
        placement_without_fields(brightest.width, brightest.height, params, texels_per_unit);
    placement.field_halvings = field_halvings(brightest);
    placement.seed = seed;
    // Fields follow what the picture shows, not how its margin fades.
    const Image mirrored = params.margin > 0.0 ? mirrored_margin(brightest, params.margin) : Image();
    const Image& shown = params.margin > 0.0 ? mirrored : brightest;
    placement.thickness = thickness_field(shown, placement.height);
    if (params.kind == StructureKind::disk) {
        placement.warp = params.warp * double(brightest.width);
        placement.flare = params.flare;
        flare_out(placement);
    } else {
        stars = {};
    }
    if (params.kind == StructureKind::walls) {
        placement.relief = shell_field(shown, placement.depth, steepest_wall);
        placement.filled = find_filled_light(shown);
    }
    if (params.kind == StructureKind::sheet && flat)
        placement.relief = relief_field(shown, placement.depth, steepest_relief);
    placement.knots = find_knots(brightest, around_stars(stars));
    set_knot_depths(placement, stars);
    return placement;
}

float Placement::scale_height(float x, float y) const { return value_at(*this, thickness, x, y); }

float Placement::relief_at(float x, float y) const { return value_at(*this, relief, x, y); }

DepthReach Placement::reach_at(float x, float y, std::uint32_t random, bool glow) const {
    constexpr float glow_in_cores = 0.94f;  // the shell's goes on; details are the core's own
    if (filled.core_share.pixels.empty()) return {DepthReach::Of::walls, relief_at(x, y)};
    const float u = as_uniform(as_mix(random ^ 0x94d049bbu));
    if (u < (glow ? glow_in_cores : 1.0f) * value_at(*this, filled.core_share, x, y))
        return {DepthReach::Of::core, value_at(*this, filled.core_reach, x, y)};
    if (u >= 1.0f - value_at(*this, filled.sky_share, x, y))
        return {DepthReach::Of::sky, sky_reach * float(depth) * sky_cushion(*this, x, y)};
    return {DepthReach::Of::walls, relief_at(x, y)};
}

float Placement::height_without_bulge(float x, float y) const {
    return float(height) * flare_at(*this, x, y);
}

float Placement::thickness_at(float x, float y) const {
    return scale_height(x, y) / height_without_bulge(x, y);
}

float middle_plane(const Placement& placement, float x, float y) {
    constexpr float begins = 0.4f;
    constexpr glm::vec2 rises(0.866f, 0.5f);  // towards there
    if (placement.warp == 0.0) return 0.0f;
    const glm::vec2 p = from_middle(placement, x, y);
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const float beyond = std::max(0.0f, (r - begins) / (1.0f - begins));
    return float(placement.warp) * beyond * beyond * (p.x * rises.x - p.y * rises.y) / std::max(r, 1e-6f);
}

float star_height(const Placement& placement, float x, float y, float u) {
    if (placement.kind != StructureKind::disk) return (2.0f * u - 1.0f) * float(placement.depth);
    return logistic(u, placement.scale_height(x, y));
}

float star_height(const Placement& placement, const Star& star) {
    const std::uint32_t random =
        as_hash(placement.seed, std::uint32_t(star.x), std::uint32_t(star.y), shared::PURPOSE_DEPTH);
    return star_height(placement, star.x, star.y, as_uniform(random));
}

}  // namespace astrosplat
