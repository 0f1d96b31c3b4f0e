// Depths are drawn for a block of splats at a time, by the kind of the structure: about a disk's plane, on or
// between two walls, or about a sheet.

#include "bodies/placement.h"
#include "core/real.h"
#include "core/shared_maths.h"

namespace astrosplat {
namespace {

using shared::as_exp, shared::as_hash, shared::as_mix, shared::as_uniform;

// Values for features of 2, 4, 8 ... 128 and 200 texels at a width of 1920, as DEPTH 3 and 4 have them, but
// for its 40, 64 and 100 of the widest splats.
using ByFeature = double[8];
constexpr ByFeature splats_each = {2.4, 4, 9, 16, 24, 24, 24, 24};  // within 2 pi sigma^2
constexpr ByFeature clumpiness = {3, 3, 2.6, 2.2, 1.7, 0.8, 0.3, 0.05};

// Between them linear in the logarithm.
double by_feature(const ByFeature& values, double feature) {
    constexpr double last = 0.644;  // octaves from 128 to 200
    const double k = std::clamp(real::log(feature / 2.0) / real::log(2.0), 0.0, 6.0 + last);
    const int i = std::min(6, int(k));
    const double t = i == 6 ? (k - 6.0) / last : k - i;
    return values[i] * (1.0 - t) + values[i + 1] * t;
}

// Gain of the first octave in a disk or between walls, for features of so many texels.
double clump_gain(const Placement& placement, double feature) {
    return whole_gain * by_feature(clumpiness, feature / placement.scale) * placement.clumps;
}

constexpr double octave_deviation = 0.26;  // of an octave's values; what is added up has 1 (depth_kernel.h)
constexpr double steady_ratio = 0.75;      // of gains of a disk's octaves and those between walls: DEPTH 4

}  // namespace

NoiseStack stack(const Placement& placement, double longest, double feature, double first_gain,
                 double ratio) {
    constexpr double shortest_wave = 5.0, waves_a_feature = 2.2;  // DEPTH 4; texels at a width of 1920
    NoiseStack noise;
    noise.seed = placement.seed;
    const double shortest = std::max(waves_a_feature * feature, shortest_wave * placement.scale);
    double gain = first_gain;
    for (double wave = longest; noise.count < NoiseStack::most; wave /= 2.0, gain *= ratio) {
        if (noise.count > 0 && wave < shortest) break;
        noise.frequency[noise.count] = float(1.0 / wave);
        noise.gain[noise.count++] = float(gain);
    }
    return noise;
}

NoiseStack waves(const Placement& placement, std::uint32_t field,
                 std::initializer_list<std::pair<double, double>> wave_and_gain) {
    NoiseStack noise;
    noise.seed = as_mix(placement.seed + field);
    for (const auto& [wave, gain] : wave_and_gain) {
        noise.frequency[noise.count] = float(1.0 / (wave * placement.scale));
        noise.gain[noise.count++] = float(gain);
    }
    return noise;
}

namespace {

constexpr float least_sigma = 0.45f;      // texels; .62 as published ends 2 dB below
constexpr double widest_filament = 45.0;  // texels at a width of 1920; what is wider is glow
// Amplitude over brightness below which splats are thinned out: of fine bands, and of others over how many
// there are (DEPTH 3).
constexpr double fine_threshold = 0.05, threshold_of_one = 0.25;
// About a sheet, of a feature: half of DEPTH 4's, which made a quarter more needles of the Bubble.
constexpr float sheet_spread = 0.25f;

float spacing_of(float sigma, double each) {
    const double area = 2.0 * real::pi * double(sigma) * double(sigma);
    return float(std::sqrt(std::max(1.0, area / each)));
}

float threshold_of(const Band& band, double each) {
    return float(band.index <= 1 ? fine_threshold : threshold_of_one / each);
}

constexpr double natural_sigma = 0.25;  // of a feature, as DEPTH 3 has most bands
// One looks into what lies about an axis from all sides: fewer large splats would be seen one by one.
constexpr double more_about_axis = 4.0;

BandSplats splats_of_size(const Band& band, bool glow, double sigma, double each) {
    BandSplats splats;
    splats.index = splats.number = band.index;
    splats.feature = float(band.feature);
    splats.spread = sheet_spread * splats.feature;
    splats.glow = glow;
    splats.sigma = band.index == 0 ? least_sigma : std::max(least_sigma, float(sigma));
    splats.spacing = spacing_of(splats.sigma, each);
    splats.threshold = threshold_of(band, each);
    return splats;
}

// A spheroid is seen into and through, so its splats are large and soft (INCLINED 3, by band), but not those
// of its stars.
constexpr int last_sharp_band = 2;
constexpr double spheroid_sigmas[] = {5.0, 9.0, 14.0, 20.0, widest_in_galaxy_px};  // beyond
constexpr double thickest_small_px = 4.0;  // sigma of the widest splats of the disk's finer bands
constexpr int last_fine_band = 3;          // the widest of what is as thin as the disk's small things

std::vector<BandSplats> splats_of_galaxy(const Band& band, double usual, const GalaxyBody& galaxy) {
    // INCLINED 3: so many bodies lie behind each other, and splats grow in number with a power of it.
    constexpr double most_behind = 12.0, least_cosine = 0.08, crowded = 0.7;
    constexpr double least_wide_px = 2.0;  // sigma of the disk's coarse bands
    const double thick = double(galaxy.thickness);
    const double least = band.index > last_fine_band ? least_wide_px : thickest_small_px,
                 widest = std::clamp(widest_in_disk * thick, least, widest_in_galaxy_px);
    // From along the normal fewer would be grains.
    const double behind =
        std::min(most_behind, std::round(1.0 / std::max(least_cosine, double(galaxy.cos_i))));
    BandSplats disk = splats_of_size(band, false, std::min(natural_sigma * band.feature, widest),
                                     usual * real::pow(behind, crowded));
    disk.family = GalaxyFamily::disk;
    const int beyond = std::min(band.index - last_sharp_band, int(std::size(spheroid_sigmas))) - 1;
    BandSplats spheroid = disk;
    if (beyond >= 0) spheroid.sigma = float(spheroid_sigmas[beyond]);
    spheroid.spacing = spacing_of(spheroid.sigma, usual);
    spheroid.threshold = threshold_of(band, usual);
    spheroid.size = 1;
    spheroid.family = GalaxyFamily::spheroid;
    return {disk, spheroid};
}

}  // namespace

std::vector<BandSplats> band_splats(const Band& band, bool coarsest, const Placement& placement) {
    const bool glow =
        placement.kind == StructureKind::walls && band.feature > widest_filament * placement.scale;
    const bool about_axis = placement.kind == StructureKind::axis;
    const double widest =
        std::max({widest_sigma_share * placement.height, glow ? widest_glow_share * placement.depth : 0.0,
                  about_axis ? widest_about_axis * placement.scale : 0.0});
    const double natural = coarsest ? 4.0 * widest : natural_sigma * band.feature;
    const double usual =
        (about_axis && band.index > last_fine_band ? more_about_axis : 1.0) *
        by_feature(splats_each, band.index == 0 ? 2.0 : std::max(4.0, band.feature / placement.scale));
    if (!placement.galaxies.empty()) return splats_of_galaxy(band, usual, placement.galaxies.front());
    return {splats_of_size(band, glow, std::min(natural, widest), usual)};
}

std::vector<BandSplats> detail_splats(const Band& band, int octaves, const Placement& placement) {
    constexpr double finest_sigma_px = double(least_sigma);
    const double px = 1.0 / double(1 << octaves);  // texels
    BandSplats splats;
    splats.octaves = octaves;
    splats.number = first_detail_number + 4 * octaves + band.index;
    splats.sigma = float(finest_sigma_px * px * (1 << band.index));
    splats.spacing = float(std::sqrt(2.0 * real::pi / splats_each[0]) * double(splats.sigma));
    splats.threshold = float(fine_threshold);
    splats.feature = float(band.feature * px);
    splats.spread = sheet_spread * splats.feature;
    if (placement.galaxies.empty()) return {splats};
    BandSplats spheroid = splats;
    splats.family = GalaxyFamily::disk;
    spheroid.family = GalaxyFamily::spheroid;
    spheroid.size = 1;
    return {splats, spheroid};
}

float share_of(const Placement& placement, const BandSplats& splats, float x, float y) {
    constexpr float sharp = 3.0f;  // times as likely is what is sharp the disk's (INCLINED 2)
    if (splats.family == GalaxyFamily::all) return 1.0f;
    float spheroid = 0.0f;
    for (const GalaxyBody& galaxy : placement.galaxies) {
        const float f = galaxy.value_at(galaxy.spheroid, x, y);
        const float mine = galaxy.share.pixels.empty() ? 1.0f : galaxy.value_at(galaxy.share, x, y);
        spheroid += mine * (splats.index > last_fine_band ? f : f / (f + sharp * (1.0f - f)));
    }
    spheroid = std::min(spheroid, 1.0f);
    return splats.family == GalaxyFamily::spheroid ? spheroid : 1.0f - spheroid;
}

namespace {

// DEPTH 4: the scale height of the finest band, of H(x, y), and what is added up to the sixth; the least
// square of it that is left when the splats' own thickness is taken off.
struct BandHeights {
    float finest, rise;
};
constexpr BandHeights band_heights{0.6f, 0.4f};
constexpr float least_square = 0.09f;         // of H(x, y)
constexpr float splats_own_thickness = 1.2f;  // square of it, of that of their sigma

// Scale heights of a band's splats: fine bands are thinner, and wide splats bring a thickness of their own.
void set_heights(const Placement& placement, const BandSplats& splats, DepthBlock& block) {
    const float share = band_heights.finest + band_heights.rise * std::min(1.0f, float(splats.index) / 5.0f);
    const float own = splats.index > 2 ? splats_own_thickness * splats.sigma * splats.sigma : 0.0f;
    for (int i = 0; i < block.count; ++i) {
        const float height = placement.scale_height(block.x[i], block.y[i]), h = height * share;
        block.height[i] = std::sqrt(std::max(h * h - own, least_square * height * height));
    }
}

// Depths within the reach of each column, which is its height here: all are as likely, and they gather in
// clouds as a disk's do.
void spread_in_clouds(const Placement& placement, double feature, DepthBlock& block) {
    std::fill_n(block.clumping, block.count, 1.0f);
    disk_depths(stack(placement, placement.depth, feature, clump_gain(placement, feature), steady_ratio),
                block);
    for (int i = 0; i < block.count; ++i)  // sech^2 becomes even
        block.z[i] = block.height[i] * (1.0f - 2.0f / (1.0f + as_exp(2.0f * block.z[i] / block.height[i])));
}

// Glow fills what is between two walls, or one would look through the holes of one wall into a hollow. Spread
// evenly in every column it would be curtains.
void fill_between_walls(const Placement& placement, double feature, PlacedBlock& block) {
    for (int i = 0; i < block.count; ++i)
        block.height[i] = std::max(block.height[i],
                                   placement.reach_at(block.x[i], block.y[i], block.random[i], true).texels);
    spread_in_clouds(placement, feature, block);
}

// Splats [begin, end) of the galaxy's own: depths of a spheroid are even, those of a disk gather in clouds.
void place_in_galaxy(const Placement& placement, const GalaxyBody& galaxy, const BandSplats& splats,
                     PlacedBlock& block) {
    if (splats.family == GalaxyFamily::spheroid) {
        for (int i = 0; i < block.count; ++i)
            block.z[i] = depth_of(galaxy, GalaxyPart::spheroid, block.x[i], block.y[i], block.even[i]);
        return;
    }
    constexpr double longest_wave = 10.0;  // of what is small in the disk: INCLINED 3
    constexpr float forces[] = {1.4f, 1.4f, 1.4f, 1.0f, 0.6f, 0.25f, 0.08f};  // by band
    const float force = forces[std::min<std::size_t>(std::size_t(splats.index), std::size(forces) - 1)];
    const bool fine = splats.index <= last_fine_band;
    DepthCandidates candidates;
    set_candidates(galaxy, fine ? GalaxyPart::fine : GalaxyPart::disk, force, block, candidates);
    // Strong clumps are flat across the line of sight; in a disk that is seen aslant they would be seen to
    // be.
    const double aslant = double(galaxy.sin_i * galaxy.sin_i);
    const double gain = std::lerp(clump_gain(placement, splats.feature),
                                  whole_gain * placement.clumps * double(force), aslant);
    line_depths(stack(placement, longest_wave * double(galaxy.thickness), splats.feature, gain, steady_ratio),
                candidates, block);
}

void place_in_galaxies(const Placement& placement, const BandSplats& splats, PlacedBlock& block) {
    place_by_galaxy(placement, block, [&](const GalaxyBody& galaxy, PlacedBlock& own) {
        place_in_galaxy(placement, galaxy, splats, own);
        if (galaxy.hidden > 0.0f && splats.family == GalaxyFamily::disk) gather_in_clouds(galaxy, own);
        for (int i = 0; i < own.count; ++i)
            own.distance[i] = std::fabs(galaxy.in_disk(own.x[i], own.y[i], own.z[i]).z);
    });
    for (int i = 0; i < block.count; ++i) block.z[i] += middle_plane(placement, block.x[i], block.y[i]);
}

constexpr float side_sharpness = 8.0f;  // of the change from one wall to the other
constexpr float least_side = 0.15f;     // share of a filament's splats on the other one: no wall is ever bare

// How many of the splats lie in front, by a smooth noise: a filament stays on one side for as long as it can.
float share_in_front(float noise) {
    return least_side + (1.0f - 2.0f * least_side) / (1.0f + as_exp(-side_sharpness * noise));
}

// -1..1 of any value.
float between(float value) { return 2.0f / (1.0f + as_exp(-2.0f * value)) - 1.0f; }

// The share of a body's light of such features that is details, which rings do not have.
double share_of_details(double feature) {
    constexpr double finest = 14.0, widest = 120.0;  // texels at a width of 1920: all is; nothing is
    return std::clamp(real::log(widest / feature) / real::log(widest / finest), 0.0, 1.0);
}

// Light that rings explain is spread over them. What they do not, and details, gathers along its line in
// clouds that all bands share: spread, it would be a streak, and on a sheet the sheet would be seen, as a
// crack where the rings' light leaps from wall to wall.
void place_about_axis(const Placement& placement, const BandSplats& splats, PlacedBlock& block) {
    constexpr double longest_wave = 330.0;  // texels at a width of 1920
    constexpr double force = 10.0;          // gain for what is no ring's at all,
    constexpr float of_details = 0.1f;      // and for details of what is, of it
    constexpr float strong_residue = 0.5f;  // from which on all of it counts
    constexpr float outermost = 0.25f;  // share of the line's light beyond which nothing gathers: with .06
                                        // the Hourglass's eye was a bar along the line
    constexpr auto places = float(DepthCandidates::count);
    const AxisDepths& axis = *placement.axis;
    const auto details = float(share_of_details(double(splats.feature) / placement.scale));
    DepthCandidates candidates{};
    for (int i = 0; i < block.count; ++i) {
        const float x = block.x[i], y = block.y[i], residue = axis.residue_at(x, y);
        const bool gathers = as_uniform(as_mix(block.random[i] ^ 0x3c6ef372u)) < std::max(details, residue);
        const float strong = std::min(1.0f, residue * residue / (strong_residue * strong_residue));
        block.clumping[i] = gathers ? std::lerp(of_details, 1.0f, strong) : 0.0f;
        const float place = block.even[i] * places, within = place - std::floor(place),
                    first = gathers ? outermost : 0.0f;
        for (int k = 0; k < DepthCandidates::count; ++k)
            candidates.z[k][i] =
                axis.depth(x, y, std::lerp(first, 1.0f - first, (float(k) + within) / places));
    }
    line_depths(stack(placement, longest_wave * placement.scale, splats.feature, force * placement.clumps,
                      steady_ratio),
                candidates, block);
}

}  // namespace

void place_small_in_galaxy(const Placement& placement, const GalaxyBody& galaxy, PlacedBlock& block) {
    BandSplats like;
    like.index = 1;
    like.feature = float(4.0 * placement.scale);
    like.family = GalaxyFamily::disk;
    place_in_galaxy(placement, galaxy, like, block);
}

void place_freely(const Placement& placement, const BandSplats& splats, PlacedBlock& block) {
    if (!placement.galaxies.empty()) {
        place_in_galaxies(placement, splats, block);
        return;
    }
    constexpr double sheet_wave = 7.0;                       // of H, the longest of the noise: DEPTH 4
    constexpr double sheet_folds = 0.22, sheet_ratio = 0.5;  // of that wave, their height; DEPTH 4
    set_heights(placement, splats, block);
    const double feature = splats.feature, h = placement.height;
    if (placement.axis) {
        place_about_axis(placement, splats, block);
    } else if (splats.glow) {
        fill_between_walls(placement, feature, block);
    } else {
        const double gain = sheet_folds * octave_deviation * sheet_wave * h * placement.clumps;
        for (int i = 0; i < block.count; ++i)
            block.clumping[i] = placement.structure_at(block.x[i], block.y[i]);
        sheet_depths(stack(placement, sheet_wave * h, feature, gain, sheet_ratio), splats.spread, block);
    }
    for (int i = 0; i < block.count; ++i) block.distance[i] = std::fabs(block.z[i]);
}

namespace {

// Scale height of a knot, of its sigma. On a sheet those along a rim that runs up the picture lie one before
// the other from aslant: each taller, they are one needle. Found by the needles of the Bubble and the
// Pillars: below .2 knots are lenses.
constexpr float knot_depth = 0.6f, knot_depth_on_sheets = 0.35f;
constexpr float round_knot_depth = 1.1f;  // sech^2 of that has the deviation of a Gaussian
constexpr float widest_in_knots = 5.0f;   // texels, sigma of the largest splats that follow their knot

const Knot& knot_of(const Placement& placement, std::int32_t knot) { return placement.knots.knots[knot]; }

// How many of a knot's splats follow it: all, about an axis those of what may be a star, but none of a smooth
// galaxy's; of a spheroid's, as of a cluster's, those of what may be a star. Beyond the galaxy, where knots
// are background galaxies, all of its light does.
float share_in_knots(const Placement& placement, const BandSplats& splats, const Knot& knot) {
    constexpr float widest_ball = 3.5f, fades_over = 2.0f;  // px, sigma of a knot
    const float compact = knot.ballness * std::clamp((widest_ball - knot.sigma) / fades_over, 0.0f, 1.0f);
    if (placement.axis) return compact;
    if (placement.galaxies.empty()) return 1.0f;
    const GalaxyBody& galaxy = placement.galaxy_at(knot.x, knot.y, 0.5f);
    const float beyond = 1.0f - galaxy.value_at(galaxy.lit, knot.x, knot.y);
    // Pieces of arms are no balls: from above a disk that is seen aslant would be made of beads.
    const float by_shape = splats.family == GalaxyFamily::spheroid ? 1.0f : galaxy.sin_i * galaxy.sin_i;
    return std::max(beyond,
                    galaxy.value_at(galaxy.roughness, knot.x, knot.y) * std::lerp(1.0f, compact, by_shape));
}

// Scale height over sigma. In a disk that is seen aslant knots are as deep as wide, or from above they were
// flat across the line of sight.
float depth_of_knots(const Placement& placement, const Knot& knot) {
    if (placement.kind == StructureKind::sheet) return knot_depth_on_sheets;
    if (placement.axis) return round_knot_depth;
    if (placement.galaxies.empty()) return knot_depth;
    const float aslant = placement.galaxy_at(knot.x, knot.y, 0.5f).sin_i;
    return std::lerp(knot_depth, round_knot_depth, aslant * aslant);
}

// On walls pieces of filaments are no knots, or these would be strings of beads.
void follow_knots(const Placement& placement, const BandSplats& splats, PlacedBlock& block) {
    const bool walls = placement.kind == StructureKind::walls;
    for (int i = 0; i < block.count; ++i) {
        const auto x = std::min(std::int64_t(block.x[i] * placement.to_light), placement.knots.width - 1);
        const auto y = std::min(std::int64_t(block.y[i] * placement.to_light), placement.knots.height - 1);
        const auto at = std::size_t(y * placement.knots.width + x);
        const std::int32_t owner = placement.knots.owner[at];
        if (owner < 0) continue;
        const Knot& knot = knot_of(placement, owner);
        const std::uint32_t random = as_mix(block.random[i] ^ 0x2c1b3c6du);
        const bool of_star = placement.axis && owner < placement.star_knots;
        const float follows =
            of_star ? 1.0f : share_in_knots(placement, splats, knot) * (walls ? knot.ballness : 1.0f);
        if (as_uniform(random) >= follows * placement.knots.weight[at]) continue;
        block.knot[i] = owner;
        const float across =
            std::clamp(as_uniform(as_mix(random)), 1e-5f, 1.0f - 1e-5f);  // a logarithm's limits
        block.z[i] = placement.knot_z[owner] +
                     0.5f * (depth_of_knots(placement, knot) * knot.sigma) * logistic(across);
    }
}

float sheet_at(const Placement& placement, float x, float y) {
    return 2.0f * placement.relief_at(x, y) - float(placement.depth);
}

// Lifts splats onto the relief of a sheet, where there is one. Under a round knot it is level, but not under
// a piece of a filament, which would become a flight of steps.
void add_relief(const Placement& placement, PlacedBlock& block) {
    if (placement.relief.pixels.empty()) return;
    for (int i = 0; i < block.count; ++i) {
        const float own = sheet_at(placement, block.x[i], block.y[i]);
        if (block.knot[i] < 0) {
            block.z[i] += own;
        } else {
            const Knot& knot = knot_of(placement, block.knot[i]);
            block.z[i] += own + knot.roundness * (sheet_at(placement, knot.x, knot.y) - own);
        }
    }
}

// Those of the sky that belong to no knot.
void spread_in_sky(const Placement& placement, double feature, const DepthReach* reaches,
                   PlacedBlock& block) {
    DepthBlock sky;
    int row[PlacedBlock::size];
    for (int i = 0; i < block.count; ++i) {
        if (reaches[i].of != DepthReach::Of::sky || block.knot[i] >= 0) continue;
        row[sky.count] = i;
        sky.x[sky.count] = block.x[i];
        sky.y[sky.count] = block.y[i];
        sky.random[sky.count] = block.random[i];
        sky.even[sky.count] = block.even[i];
        sky.height[sky.count++] = reaches[i].texels;
    }
    if (sky.count == 0) return;
    spread_in_clouds(placement, feature, sky);
    for (int k = 0; k < sky.count; ++k) block.z[row[k]] = sky.z[k];
}

// Puts splats onto one of two walls, front or back, and bends these. A filament stays on one wall for as long
// as it can; what belongs to a knot is where its middle is. Light of a core or of the sky is anywhere within
// its reach. Waves in texels at a width of 1920, as DEPTH 4 has them but for shorter ones of the sides.
void add_walls(const Placement& placement, double feature, PlacedBlock& block) {
    DepthBlock side = block;
    for (int i = 0; i < block.count; ++i) {
        if (block.knot[i] < 0) continue;
        const Knot& knot = knot_of(placement, block.knot[i]);
        side.x[i] = knot.x;
        side.y[i] = knot.y;
    }
    DepthBlock bend = side, within = side;
    const double unit = octave_deviation * placement.depth;
    noise_sum(waves(placement, 1, {{220.0, 1.0}, {90.0, 0.6}}), side);
    noise_sum(waves(placement, 2, {{520.0, 0.22 * unit}, {210.0, 0.07 * unit}}), bend);
    noise_sum(waves(placement, 3, {{640.0, 1.0}, {260.0, 0.3}}), within);
    DepthReach reaches[PlacedBlock::size];
    for (int i = 0; i < block.count; ++i) {
        const std::uint32_t random = block.knot[i] < 0 ? block.random[i]
                                                       : as_hash(placement.seed, std::uint32_t(block.knot[i]),
                                                                 1u, shared::PURPOSE_KNOT);
        const bool in_front = as_uniform(as_mix(random ^ 0x5bd1e995u)) < share_in_front(side.z[i]);
        const float anywhere = 2.0f * as_uniform(as_mix(random ^ 0x27d4eb2fu)) - 1.0f;
        reaches[i] = placement.reach_at(bend.x[i], bend.y[i], random, false);
        const float at = reaches[i].of == DepthReach::Of::walls  ? (in_front ? 1.0f : -1.0f)
                         : reaches[i].of == DepthReach::Of::core ? between(within.z[i])
                                                                 : anywhere;
        block.z[i] += at * reaches[i].texels + bend.z[i];
    }
    spread_in_sky(placement, feature, reaches, block);
}

}  // namespace

void add_small(float x, float y, std::uint32_t random, PlacedBlock& block) {
    const int i = block.count++;
    block.x[i] = x;
    block.y[i] = y;
    block.random[i] = random;
    block.even[i] = as_uniform(as_mix(random));
}

void copy_splat(const DepthBlock& from, int i, DepthBlock& to, int k) {
    to.x[k] = from.x[i];
    to.y[k] = from.y[i];
    to.random[k] = from.random[i];
    to.even[k] = from.even[i];
    to.z[k] = from.z[i];
}

void copy_splat(const PlacedBlock& from, int i, PlacedBlock& to, int k) {
    copy_splat(static_cast<const DepthBlock&>(from), i, static_cast<DepthBlock&>(to), k);
    to.distance[k] = from.distance[i];
    to.knot[k] = from.knot[i];
}

bool none_in_knots(std::span<const Band> bands, const Placement& placement) {
    return std::ranges::all_of(bands, [&](const Band& band) {
        return std::ranges::all_of(band_splats(band, &band == &bands.back(), placement),
                                   [](const BandSplats& splats) { return splats.sigma > widest_in_knots; });
    });
}

void place(const Placement& placement, const BandSplats& splats, PlacedBlock& block) {
    place_freely(placement, splats, block);
    std::fill_n(block.knot, block.count, -1);
    if (splats.sigma <= widest_in_knots && !placement.knots.knots.empty())
        follow_knots(placement, splats, block);
    if (placement.kind == StructureKind::sheet) add_relief(placement, block);
    if (placement.kind == StructureKind::walls && !splats.glow)
        add_walls(placement, double(splats.feature), block);
}

}  // namespace astrosplat
