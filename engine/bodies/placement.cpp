#include "bodies/placement.h"

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

// Of a field of the picture's, at a place of the picture.
float value_at(const Placement& placement, const Image& field, float x, float y) {
    const float share = placement.to_light / float(1 << placement.field_halvings);
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

// Depths of a galaxy's clouds, as those of splats of the second finest band.
void set_cloud_depths(Placement& placement, GalaxyBody& galaxy) {
    // Of the disk's radius. INCLINED 3 has .045 of the picture's width, about .13 of its galaxies' radii: one
    // seen quite from its edge, as NGC 891, was a dozen soft balls from above.
    constexpr double in_radii = 0.06;
    const double length = in_radii * double(galaxy.radius) / double(placement.picture_width);
    GalaxyClouds& clouds = galaxy.clouds;
    clouds.length = float(length * double(placement.picture_width));
    clouds.columns = clouds.rows = 2 * std::int64_t(std::ceil(1.0 / length)) + 1;
    clouds.rows = std::int64_t(float(clouds.rows) / cloud_flat);
    clouds.z.resize(std::size_t(clouds.columns * clouds.rows));
    const std::vector<std::size_t> reached =
        reached_clouds(galaxy, float(placement.picture_width), float(placement.picture_height));
    parallel_chunks(std::ssize(reached), DepthBlock::size, [&](std::int64_t begin, std::int64_t end, int) {
        PlacedBlock block;
        for (const std::size_t i : std::span(reached).subspan(begin, end - begin)) {
            const glm::vec2 place = place_of(galaxy, clouds.middle(i));
            add_small(place.x, place.y, as_hash(placement.seed, std::uint32_t(i), 2u, shared::PURPOSE_KNOT),
                      block);
        }
        place_small_in_galaxy(placement, galaxy, block);
        for (int k = 0; k < block.count; ++k) clouds.z[reached[std::size_t(begin + k)]] = block.z[k];
    });
}

// Whether a knot is not the disk's but the spheroid's, or lies somewhere behind or before the galaxy.
bool is_off_disk(const Placement& placement, float x, float y, std::uint32_t random) {
    const GalaxyBody& galaxy = placement.galaxy_at(x, y, 0.5f);
    const float spheroid = galaxy.value_at(galaxy.spheroid, x, y);
    return as_uniform(as_mix(random ^ 0x1f83d9abu)) >= galaxy.value_at(galaxy.lit, x, y) * (1.0f - spheroid);
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
        for (std::int64_t i = begin; i < end; ++i) {
            const Knot& knot = placement.knots.knots[i];
            add_small(knot.x, knot.y, as_hash(placement.seed, std::uint32_t(i), 0u, shared::PURPOSE_KNOT),
                      block);
        }
        place_freely(placement, like, block);
        for (int i = 0; i < block.count; ++i) {
            if (!placement.galaxies.empty() &&
                is_off_disk(placement, block.x[i], block.y[i], block.random[i]))
                block.z[i] =
                    star_height(placement, block.x[i], block.y[i], as_uniform(as_mix(block.random[i]))) +
                    middle_plane(placement, block.x[i], block.y[i]);
            placement.knot_z[begin + i] = block.z[i];
        }
    });
    for (const Star& star : stars)
        placement.knot_z[star.body] = star_height(placement, star) + middle_plane(placement, star.x, star.y);
}

// A nebula's own star is in its middle.
bool is_central(const Placement& placement, const Star& star) {
    constexpr double about = 0.015;  // picture widths
    const double width = double(placement.picture_width);
    return placement.axis && std::hypot(double(star.x) / width - placement.axis->fit.x,
                                        double(star.y) / width - placement.axis->fit.y) < about;
}

// The picture without its margin.
Image inside_margin(const Image& light, std::int64_t margin_px) {
    return part_of(light, {margin_px, margin_px, light.width - 2 * margin_px, light.height - 2 * margin_px});
}

// Lengths in other units; unchanged by 1.
Image times(Image lengths, double factor) {
    if (factor != 1.0)
        for (float& length : lengths.pixels) length *= float(factor);
    return lengths;
}

void scale(std::vector<Knot>& knots, float factor) {
    for (Knot& knot : knots) {
        knot.x *= factor;
        knot.y *= factor;
        knot.sigma *= factor;
    }
}

// Made once where there is a sight, which keeps it.
template <class T, class Make>
T made_once(PlacementSight* sight, std::optional<T> PlacementSight::*member, const Make& make) {
    if (!sight) return make();
    std::optional<T>& kept = sight->*member;
    if (!kept) kept = make();
    return *kept;
}

// How many times as thick as by itself the scene wants a disk to be.
double times_as_thick(const StructureParams& params, double texels_per_unit, const Placement& placement) {
    if (!(params.height > 0.0)) return 1.0;
    StructureParams automatic = params;
    automatic.height = 0.0;
    return placement.height / placement_without_fields(placement.picture_width, placement.picture_height,
                                                       automatic, texels_per_unit)
                                  .height;
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
    placement.detail = DetailLevels(params, width, height);
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

Placement make_placement(const Image& light, const StructureParams& params, double texels_per_unit, bool flat,
                         std::uint32_t seed, std::span<const Star> stars, std::optional<AxisDepths> axis,
                         ImageSize size, PlacementSight* sight) {
    if (size.width == 0) size = {light.width, light.height};
    Placement placement = placement_without_fields(size.width, size.height, params, texels_per_unit);
    placement.to_light = float(double(light.width) / double(size.width));
    const double px = double(placement.to_light), texels = 1.0 / px;
    const Image brightest = brightest_channel(light);
    placement.field_halvings = field_halvings(brightest);
    placement.seed = seed;
    // Fields follow what the picture shows, not how its margin fades.
    const Image mirrored = params.margin > 0.0 ? mirrored_margin(brightest, params.margin) : Image();
    const Image& shown = params.margin > 0.0 ? mirrored : brightest;
    if (params.kind == StructureKind::disk) {
        placement.warp = params.warp * double(size.width);
        const auto margin_of = [&](std::int64_t width) {
            return std::llround(double(width) * params.margin / (1.0 + 2.0 * params.margin));
        };
        const auto margin_px = margin_of(light.width), margin = margin_of(size.width);
        placement.galaxies =
            galaxies_of(margin_px > 0 ? inside_margin(light, margin_px) : light, params,
                        times_as_thick(params, texels_per_unit, placement), size.width - 2 * margin, margin,
                        seed, sight ? &sight->galaxies : nullptr);
    } else {
        placement.thickness = times(thickness_field(shown, placement.height * px), texels);
        placement.structure =
            made_once(sight, &PlacementSight::structure, [&] { return structure_field(shown); });
        if (!axis) stars = {};
    }
    if (params.kind == StructureKind::walls) {
        Image balloon = made_once(sight, &PlacementSight::balloon, [&] { return balloon_of(shown); });
        placement.relief =
            times(shell_field(shown, std::move(balloon), placement.depth * px, steepest_wall), texels);
        placement.filled =
            made_once(sight, &PlacementSight::filled, [&] { return find_filled_light(shown); });
        placement.filled.core_reach = times(std::move(placement.filled.core_reach), texels);
    }
    if (params.kind == StructureKind::sheet && flat)
        placement.relief = times(relief_field(shown, placement.depth * px, steepest_relief), texels);
    for (GalaxyBody& galaxy : placement.galaxies)
        if (galaxy.hidden > 0.0f) set_cloud_depths(placement, galaxy);
    if (axis) placement.depth = axis->fit.reach * double(size.width);
    placement.axis = std::move(axis);
    std::vector<Knot> around = around_stars(stars);
    placement.star_knots = std::int32_t(around.size());
    scale(around, placement.to_light);
    if (sight && std::exchange(sight->knots_around, around.size()) != around.size()) sight->knots.reset();
    placement.knots = made_once(sight, &PlacementSight::knots, [&] { return find_knots(brightest, around); });
    scale(placement.knots.knots, float(texels));
    set_knot_depths(placement, stars);
    return placement;
}

Placement placement_to_count(const Texture& texture, const StructureParams& params) {
    constexpr double enough_texels = 512.0 * 512.0;  // to fit a galaxy in
    const Image& image = texture.image;
    Placement placement = placement_without_fields(image.width, image.height, params, 0.0);
    if (params.kind != StructureKind::disk) return placement;
    Texture small;
    small.alpha_from_light = texture.alpha_from_light;
    small.image = at_area(image, std::min(enough_texels, double(image.width * image.height)), 1.0);
    const auto share = params.margin / (1.0 + 2.0 * params.margin);
    const auto margin_px = [&](std::int64_t width) { return std::llround(share * double(width)); };
    placement.galaxies =
        galaxies_of(inside_margin(picture_light(small, 0.0).light, margin_px(small.image.width)), params, 1.0,
                    image.width - 2 * margin_px(image.width), margin_px(image.width), 0);
    return placement;
}

float Placement::scale_height(float x, float y) const { return value_at(*this, thickness, x, y); }

float Placement::structure_at(float x, float y) const { return value_at(*this, structure, x, y); }

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

const GalaxyBody& Placement::galaxy_at(float x, float y, float random) const {
    for (const GalaxyBody& galaxy : galaxies)
        if (galaxy.share.pixels.empty() || (random -= galaxy.value_at(galaxy.share, x, y)) < 0.0f)
            return galaxy;
    return galaxies.back();
}

const GalaxyBody& Placement::galaxy_at(float x, float y, std::uint32_t random) const {
    return galaxy_at(x, y, as_uniform(as_mix(random ^ 0x6a09e667u)));
}

float middle_plane(const Placement& placement, float x, float y) {
    constexpr float begins = 0.4f;
    constexpr glm::vec2 rises(0.866f, 0.5f);  // towards there
    if (placement.warp == 0.0) return 0.0f;
    const glm::vec2 p = from_middle(placement, x, y);
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const float beyond = std::max(0.0f, (r - begins) / (1.0f - begins));
    const float rise = (p.x * rises.x - p.y * rises.y) / std::max(r, 1e-6f);
    return float(placement.warp) * beyond * beyond * rise * placement.galaxies.front().cos_i;
}

float star_height(const Placement& placement, float x, float y, float u) {
    if (placement.kind != StructureKind::disk) return (2.0f * u - 1.0f) * float(placement.depth);
    const GalaxyBody& galaxy = placement.galaxy_at(x, y, 0.5f);
    const float in_disk = galaxy.value_at(galaxy.lit, x, y) * (1.0f - galaxy.value_at(galaxy.spheroid, x, y));
    return star_depth(galaxy, x, y, u, in_disk);
}

float star_height(const Placement& placement, const Star& star) {
    if (is_central(placement, star)) return 0.0f;
    const std::uint32_t random =
        as_hash(placement.seed, std::uint32_t(star.x), std::uint32_t(star.y), shared::PURPOSE_DEPTH);
    return star_height(placement, star.x, star.y, as_uniform(random));
}

}  // namespace astrosplat
