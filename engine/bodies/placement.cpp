#include "bodies/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "bodies/fields.h"
#include "bodies/margin.h"
#include "bodies/picture_light.h"
#include "bodies/surfaces.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

using shared::as_hash, shared::as_log, shared::as_mix, shared::as_uniform;

constexpr float least_sigma = 0.45f;  // texels; .62 as published ends 2 dB below
// Scale height of a knot, of its sigma. On a sheet those along a rim that runs up the picture lie one before
// the other from aslant: each taller, they are one needle.
// Of a knot's sigma. On sheets found by the needles of the Bubble and the Pillars: below .2 knots are lenses.
constexpr float knot_depth = 0.6f, knot_depth_on_sheets = 0.35f;
constexpr float widest_in_knots = 5.0f;   // texels, sigma of the largest dots that follow their knot
constexpr double widest_filament = 45.0;  // texels at a width of 1920; what is wider is glow

constexpr float sky_reach = 0.8f;  // around a shell, of its greatest

constexpr double dots_each[8] = {2.4, 4, 9, 16, 24, 24, 24, 24};  // within 2 pi sigma^2
constexpr double crowd_in_bulges = 32.0;  // times as many wide dots there, or its outline would be ragged

// Of a place, from the middle of the picture, in halves of its longest side.
glm::vec2 from_middle(const Placement& placement, float x, float y) {
    const auto w = static_cast<float>(placement.picture_width),
               h = static_cast<float>(placement.picture_height);
    return glm::vec2(x - 0.5f * w, y - 0.5f * h) * (2.0f / std::max(w, h));
}

float flare_at(const Placement& placement, float x, float y) {
    const glm::vec2 p = from_middle(placement, x, y);
    return 1.0f + static_cast<float>(placement.flare) * (p.x * p.x + p.y * p.y);
}

// Of a dot in a bulge, where the disk alone would be `disk` thick: most are near the plane and few high up,
// as in a ball of stars. All as high as the bulge would be a tower.
float height_in_bulge(float disk, float bulge, std::uint32_t random) {
    return disk + (bulge - disk) * as_uniform(as_mix(random ^ 0x1b56c4e9u));
}

// Scale heights of a band's dots: fine bands are thinner, and wide dots bring a thickness of their own.
void set_heights(const Placement& placement, const BandDots& dots, DepthBlock& block) {
    const float fine = std::min(1.0f, static_cast<float>(dots.index) / 5.0f);
    const float share = placement.kind == StructureKind::disk ? 0.45f + 0.55f * fine : 0.6f + 0.4f * fine;
    const float own = dots.index > 2 ? 1.2f * dots.sigma * dots.sigma : 0.0f;
    const float typical = static_cast<float>(placement.height);
    const bool bulges = placement.kind == StructureKind::disk;
    for (int i = 0; i < block.count; ++i) {
        const float whole = placement.scale_height(block.x[i], block.y[i]);
        const float disk = typical * flare_at(placement, block.x[i], block.y[i]);
        const float height = bulges && whole > disk ? height_in_bulge(disk, whole, block.random[i]) : whole;
        const float h = height * share, flat = std::min(1.0f, disk / whole);
        block.clumping[i] = flat * flat * flat * flat;  // a bulge is smooth
        block.height[i] = std::sqrt(std::max(h * h - own, 0.09f * height * height));
    }
}

// How deep the sky around a shell is, of its greatest: like a cushion, or the picture's straight edges would
// be seen from aslant as those of a slab.
float sky_cushion(const Placement& placement, float x, float y) {
    constexpr float thinnest = 0.15f;
    const float u = 2.0f * x / static_cast<float>(placement.picture_width) - 1.0f,
                v = 2.0f * y / static_cast<float>(placement.picture_height) - 1.0f;
    return std::max(thinnest, std::sqrt(std::max(0.0f, 1.0f - u * u * u * u - v * v * v * v)));
}

float logistic(float u, float height) {
    const float inside = std::clamp(u, 1e-5f, 1.0f - 1e-5f);
    return 0.5f * height * as_log(inside / (1.0f - inside));
}

void place_freely(const Placement& placement, const BandDots& dots, PlacedBlock& block) {
    set_heights(placement, dots, block);
    const double feature = dots.feature, h = placement.height;
    if (placement.kind == StructureKind::disk) {
        const double gain = clump_gain(placement, feature);
        disk_depths(stack(placement, 4.0 * h, feature, gain, 0.75), block);
    } else if (dots.glow) {
        fill_between_walls(placement, feature, block);
    } else {
        const double gain = 0.22 * 0.26 * 7.0 * h * placement.clumps;
        sheet_depths(stack(placement, 7.0 * h, feature, gain, 0.5), dots.spread, block);
    }
    for (int i = 0; i < block.count; ++i) block.distance[i] = std::fabs(block.z[i]);
    for (int i = 0; i < block.count; ++i) block.z[i] += middle_plane(placement, block.x[i], block.y[i]);
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

void set_knot_depths(Placement& placement, std::span<const Star> stars) {
    BandDots like;
    like.index = 1;
    like.sigma = like.spacing = 1.0f;
    like.feature = static_cast<float>(4.0 * placement.scale);
    const auto count = static_cast<std::int64_t>(placement.knots.knots.size());
    placement.knot_z.resize(static_cast<std::size_t>(count));
    parallel_chunks(count, DepthBlock::size, [&](std::int64_t begin, std::int64_t end, int) {
        PlacedBlock block;
        block.count = static_cast<int>(end - begin);
        for (int i = 0; i < block.count; ++i) {
            const Knot& knot = placement.knots.knots[static_cast<std::size_t>(begin + i)];
            block.x[i] = knot.x;
            block.y[i] = knot.y;
            block.random[i] =
                as_hash(placement.seed, static_cast<std::uint32_t>(begin + i), 0u, shared::PURPOSE_KNOT);
        }
        place_freely(placement, like, block);
        std::copy_n(block.z, block.count, placement.knot_z.data() + begin);
    });
    for (const Star& star : stars)
        placement.knot_z[star.body] = star_height(placement, star) + middle_plane(placement, star.x, star.y);
}

// On walls pieces of filaments are no knots, or these would be strings of beads.
void follow_knots(const Placement& placement, PlacedBlock& block) {
    const bool walls = placement.kind == StructureKind::walls;
    const float depth = placement.kind == StructureKind::sheet ? knot_depth_on_sheets : knot_depth;
    for (int i = 0; i < block.count; ++i) {
        const auto x = std::min(static_cast<std::int64_t>(block.x[i]), placement.picture_width - 1);
        const auto y = std::min(static_cast<std::int64_t>(block.y[i]), placement.picture_height - 1);
        const auto at = static_cast<std::size_t>(y * placement.picture_width + x);
        const std::int32_t owner = placement.knots.owner[at];
        const std::uint32_t random = as_mix(block.random[i] ^ 0x2c1b3c6du);
        if (owner < 0) continue;
        const auto knot = static_cast<std::size_t>(owner);
        const float weight =
            placement.knots.weight[at] * (walls ? placement.knots.knots[knot].ballness : 1.0f);
        if (as_uniform(random) >= weight) continue;
        block.knot[i] = owner;
        block.z[i] = placement.knot_z[knot] +
                     logistic(as_uniform(as_mix(random)), depth * placement.knots.knots[knot].sigma);
    }
}

}  // namespace

Placement placement_without_fields(std::int64_t width, std::int64_t height, const StructureParams& params,
                                   double texels_per_unit) {
    const double share = params.kind == StructureKind::disk ? disk_thickness : sheet_thickness;
    Placement placement;
    placement.kind = params.kind;
    placement.picture_width = width;
    placement.picture_height = height;
    const double width_without_margin = static_cast<double>(width) / (1.0 + 2.0 * params.margin);
    placement.scale = width_without_margin / 1920.0;
    const double longest_of_picture = std::max(
        width_without_margin, static_cast<double>(height) - 2.0 * params.margin * width_without_margin);
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
        placement.warp = params.warp * static_cast<double>(brightest.width);
        placement.flare = params.flare;
        Image& field = placement.thickness;
        const auto middle = [&](std::int64_t i) {
            return (static_cast<float>(i) + 0.5f) * static_cast<float>(1 << placement.field_halvings);
        };
        parallel_for(field.height, [&](std::int64_t y, int) {
            for (std::int64_t x = 0; x < field.width; ++x)
                *field.at(x, y) *= flare_at(placement, middle(x), middle(y));
        });
    }
    if (params.kind == StructureKind::walls) {
        placement.relief = shell_field(shown, placement.depth, 0.8);
        placement.filled = find_filled_light(shown);
    }
    if (params.kind == StructureKind::sheet && flat)
        placement.relief = relief_field(shown, placement.depth, 0.6);  // counts twice
    if (params.kind != StructureKind::disk) stars = {};
    placement.knots = find_knots(brightest, around_stars(stars));
    set_knot_depths(placement, stars);
    return placement;
}

float Placement::scale_height(float x, float y) const {
    const float share = 1.0f / static_cast<float>(1 << field_halvings);
    return bilinear(thickness, 0, x * share, y * share);
}

float Placement::relief_at(float x, float y) const {
    const float share = 1.0f / static_cast<float>(1 << field_halvings);
    return bilinear(relief, 0, x * share, y * share);
}

DepthReach Placement::reach_at(float x, float y, std::uint32_t random, bool glow) const {
    constexpr float glow_in_cores = 0.94f;  // the shell's goes on; details are the core's own
    if (filled.core_share.pixels.empty()) return {DepthReach::Of::walls, relief_at(x, y)};
    const float share = 1.0f / static_cast<float>(1 << field_halvings);
    const auto of = [&](const Image& field) { return bilinear(field, 0, x * share, y * share); };
    const float u = as_uniform(as_mix(random ^ 0x94d049bbu));
    if (u < (glow ? glow_in_cores : 1.0f) * of(filled.core_share))
        return {DepthReach::Of::core, of(filled.core_reach)};
    if (u >= 1.0f - of(filled.sky_share))
        return {DepthReach::Of::sky, sky_reach * static_cast<float>(depth) * sky_cushion(*this, x, y)};
    return {DepthReach::Of::walls, relief_at(x, y)};
}

float Placement::thickness_at(float x, float y) const {
    return scale_height(x, y) / (static_cast<float>(height) * flare_at(*this, x, y));
}

float middle_plane(const Placement& placement, float x, float y) {
    constexpr float begins = 0.4f;
    constexpr glm::vec2 rises(0.866f, 0.5f);  // towards there
    if (placement.warp == 0.0) return 0.0f;
    const glm::vec2 p = from_middle(placement, x, y);
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const float beyond = std::max(0.0f, (r - begins) / (1.0f - begins));
    return static_cast<float>(placement.warp) * beyond * beyond * (p.x * rises.x - p.y * rises.y) /
           std::max(r, 1e-6f);
}

float star_height(const Placement& placement, float x, float y, float u) {
    if (placement.kind != StructureKind::disk) return (2.0f * u - 1.0f) * static_cast<float>(placement.depth);
    return logistic(u, placement.scale_height(x, y));
}

float star_height(const Placement& placement, const Star& star) {
    const std::uint32_t random = as_hash(placement.seed, static_cast<std::uint32_t>(star.x),
                                         static_cast<std::uint32_t>(star.y), shared::PURPOSE_DEPTH);
    return star_height(placement, star.x, star.y, as_uniform(random));
}

std::vector<BandDots> band_dots(const Band& band, bool coarsest, const Placement& placement) {
    const bool glow =
        placement.kind == StructureKind::walls && band.feature > widest_filament * placement.scale;
    const double widest =
        std::max(widest_sigma_share * placement.height, glow ? widest_glow_share * placement.depth : 0.0);
    const double natural = coarsest ? 4.0 * widest : band.feature / 4.0;
    const double usual =
        by_feature(dots_each, band.index == 0 ? 2.0 : std::max(4.0, band.feature / placement.scale));
    const auto of_size = [&](double sigma, double each) {
        BandDots dots;
        dots.index = band.index;
        dots.feature = static_cast<float>(band.feature);
        dots.spread = 0.25f * dots.feature;
        dots.glow = glow;
        dots.sigma = band.index == 0 ? least_sigma : std::max(least_sigma, static_cast<float>(sigma));
        const double s = static_cast<double>(dots.sigma), area = 2.0 * real::pi * s * s;
        dots.spacing = static_cast<float>(std::sqrt(std::max(1.0, area / each)));
        dots.threshold = static_cast<float>(band.index <= 1 ? 0.05 : 0.25 / each);
        return dots;
    };
    std::vector<BandDots> sizes{of_size(std::min(natural, widest), usual)};
    if (placement.kind != StructureKind::disk) return sizes;
    for (const float thickness : wider_in_bulges) {
        const double sigma = std::min(natural, static_cast<double>(thickness) * widest);
        if (static_cast<float>(sigma) <= sizes.back().sigma) break;
        sizes.back().thickness_to = thickness;
        sizes.push_back(of_size(sigma, crowd_in_bulges * usual));
        sizes.back().thickness_from = thickness;
        sizes.back().size = static_cast<int>(sizes.size()) - 1;
    }
    return sizes;
}

void place(const Placement& placement, const BandDots& dots, PlacedBlock& block) {
    place_freely(placement, dots, block);
    std::fill_n(block.knot, block.count, -1);
    if (dots.sigma <= widest_in_knots && !placement.knots.knots.empty()) follow_knots(placement, block);
    if (placement.kind == StructureKind::sheet) add_relief(placement, block);
    if (placement.kind == StructureKind::walls && !dots.glow)
        add_walls(placement, static_cast<double>(dots.feature), block);
}

}  // namespace astrosplat
