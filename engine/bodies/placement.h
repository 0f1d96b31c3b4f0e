// Where in depth each splat of a picture goes (DEPTH 4). In: the picture's light without stars and what the
// scene says of its structure. Out: depths of splats, in texels towards the viewer.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>

#include "bodies/axis_depths.h"
#include "bodies/depth_kernel.h"
#include "bodies/detail_levels.h"
#include "bodies/fields.h"
#include "bodies/galaxies.h"
#include "bodies/galaxy_body.h"
#include "bodies/picture_light.h"
#include "bodies/stars.h"
#include "core/image.h"
#include "core/shared_maths.h"
#include "detect/peaks.h"
#include "image/resample.h"
#include "source/source.h"
#include "source/texture.h"

namespace astrosplat {

/// Scale heights by themselves, of a picture's longest side.
inline constexpr double disk_thickness = 0.018, sheet_thickness = 0.011;
/// Sigma of the widest splats, of the scale height; larger ones would be a fog of their own.
inline constexpr double widest_sigma_share = 0.45;
/// The same of the glow between two walls, of how far each of them stands out.
inline constexpr double widest_glow_share = 0.06;
/// The same of a body of revolution, texels at a width of 1920.
inline constexpr double widest_about_axis = 10.0;
/// The same of a galaxy's disk, of the thickness of what is small in it (INCLINED 3).
inline constexpr double widest_in_disk = 1.3;
/// Sigma of the widest splats of a galaxy, texels.
inline constexpr double widest_in_galaxy_px = 28.0;

/// How far from the middle light of a shell lies: on its two walls, or anywhere between in a core or the sky.
struct DepthReach {
    enum class Of { walls, core, sky } of = Of::walls;
    float texels = 0.0f;
};

/// Values that depths depend on besides a splat's own place and band.
struct Placement {
    StructureKind kind = StructureKind::disk;
    double scale = 1.0;   // the picture's width over 1920 px, by which wavelengths grow
    DetailLevels detail;  // where the finest band has splats below its texels
    double height = 0.0;  // texels, typical scale height H
    double depth = 0.0;   // texels, from the middle to the front of a relief or a wall
    double clumps = 1.0;
    double warp = 0.0;  // texels, of a disk's plane at its rim
    std::uint32_t seed = 0;
    std::int64_t picture_width = 0, picture_height = 0;  // texels
    float to_light = 1.0f;                               // px of the light that it was made of, a texel
    int field_halvings = 0;                              // of the light's size to that of the fields:
    std::vector<GalaxyBody> galaxies;                    // of a disk; else empty
    Image thickness;                                     // H(x, y), texels, of other kinds
    Image structure;                                     // of other kinds, by how much their sheets fold
    Image relief;        // how far the middle of a sheet or a wall stands out, texels; empty: not at all
    FilledLight filled;  // of what has walls; empty: none
    std::optional<AxisDepths> axis;  // of a body of revolution
    Knots knots;                     // each at one depth; first those around stars, by their bodies
    std::int32_t star_knots = 0;     // how many of them are around stars
    std::vector<float> knot_z;       // theirs, texels

    /// Values of the fields at a place of the picture.
    float scale_height(float x, float y) const;
    float structure_at(float x, float y) const;
    float relief_at(float x, float y) const;
    /// The galaxy that light at a place belongs to, by a random number where there are several; 0..1.
    const GalaxyBody& galaxy_at(float x, float y, float random) const;
    const GalaxyBody& galaxy_at(float x, float y, std::uint32_t random) const;
    /// Of a splat, by the shares of its column's light; `glow`: of the light between the walls, not details.
    DepthReach reach_at(float x, float y, std::uint32_t random, bool glow) const;
    /// Where a place at this height is among splats: from the middle of the picture, y up.
    glm::vec3 among_splats(float x, float y, float z) const {
        return {x - 0.5f * float(picture_width), 0.5f * float(picture_height) - y, z};
    }
    /// A hash of a splat for one purpose.
    std::uint32_t hash_of(std::uint64_t id, std::uint32_t purpose) const {
        return shared::as_hash(seed, std::uint32_t(id), std::uint32_t(id >> 32), purpose);
    }
};

/// What make_placement() found in one light and its stars for the model before, where a hand changes the
/// model: the next one finds only what differs.
struct PlacementSight {
    GalaxySight galaxies;
    std::optional<Image> structure, balloon;
    std::optional<FilledLight> filled;
    std::optional<Knots> knots;
    std::size_t knots_around = 0;  // so many stars
};

/// `texels_per_unit`: of the surface that carries the picture; `flat`: it is a plane, so a sheet takes its
/// relief from the picture instead. What `stars` of a disk leave around themselves stays at their depth: a
/// profile is never quite that of their Gaussians, and would be a row of splats in depth. `axis`: of the
/// kind. `size`: of the picture, where `light` is smaller; 0: as that. `sight`: may be null.
Placement make_placement(const Image& light, const StructureParams& params, double texels_per_unit, bool flat,
                         std::uint32_t seed, std::span<const Star> stars = {},
                         std::optional<AxisDepths> axis = {}, ImageSize size = {0, 0},
                         PlacementSight* sight = nullptr);

/// What the number of splats depends on, besides the light: no fields, but the galaxies of a disk.
Placement placement_to_count(const Texture& texture, const StructureParams& params);

/// The part of it that no picture has to be looked at for.
Placement placement_without_fields(std::int64_t width, std::int64_t height, const StructureParams& params,
                                   double texels_per_unit);

/// Height of a disk's middle plane over that of its galaxy, texels: bent like an integral sign from .4 of the
/// way to the rim on, which is half the longest side from the middle. 0 for other kinds.
float middle_plane(const Placement& placement, float x, float y);

/// Height over the middle plane below which the share `u` (0..1) of the layer's stars lies, texels: of a disk
/// by the galaxy's disk and spheroid, of others even over the whole depth.
float star_height(const Placement& placement, float x, float y, float u);
/// The same of a star of the picture; its share is a random number of the pixel that it is in.
float star_height(const Placement& placement, const Star& star);

/// Octaves from `longest` on by halves, texels, as far down as a feature of so many texels allows: small
/// things float where their cloud floats. Each has `ratio` times the gain of the one before.
NoiseStack stack(const Placement& placement, double longest, double feature, double first_gain, double ratio);

/// These octaves, in texels at a width of 1920, of a field of their own.
NoiseStack waves(const Placement& placement, std::uint32_t field,
                 std::initializer_list<std::pair<double, double>> wave_and_gain);

/// Gain of the first octave of noise that depths in a disk or between walls gather in, where all of it counts
/// (DEPTH 4).
inline constexpr double whole_gain = 1.6;

/// What light of a galaxy is; of other kinds: all.
enum class GalaxyFamily { all, disk, spheroid };

/// How the splats of one band are made (DEPTH 3), lengths in texels.
struct BandSplats {
    int index = 0, size = 0;  // of the band; of its sizes
    int octaves = 0;          // of the finest band: below its texels, where the picture has so many
    int number = 0;           // in ids
    float sigma = 0.0f;       // of a splat
    float spacing = 0.0f;     // of the lattice they are drawn on
    float threshold = 0.0f;   // amplitude over brightness below which they are thinned out
    float feature = 0.0f;
    float spread = 0.0f;  // about a sheet
    bool glow = false;    // fills what is between two walls, and hides little
    GalaxyFamily family = GalaxyFamily::all;
};
/// One size; of a galaxy one for its disk and one for its spheroid.
std::vector<BandSplats> band_splats(const Band& band, bool coarsest, const Placement& placement);

/// Numbers of invented detail in ids, beyond those of all bands: this, four times the octaves and the band.
inline constexpr int first_detail_number = 128;

/// Those of a band of invented detail, blurs in px of so many octaves below the texels.
std::vector<BandSplats> detail_splats(const Band& band, int octaves, const Placement& placement);

/// A block's splats with their distances from the middle of what they belong to.
struct PlacedBlock : DepthBlock {
    float distance[size];     // texels, >= 0
    std::int32_t knot[size];  // whose depth it has; or -1
};

/// Adds something by itself, without neighbours to be even with.
void add_small(float x, float y, std::uint32_t random, PlacedBlock& block);

/// Values of one splat of a block, to another's place.
void copy_splat(const DepthBlock& from, int i, DepthBlock& to, int k);
void copy_splat(const PlacedBlock& from, int i, PlacedBlock& to, int k);

/// Whether no splats of these bands, which end with the coarsest, follow a knot.
bool none_in_knots(std::span<const Band> bands, const Placement& placement);

/// The share of the light at a place of the picture that such splats show, 0..1.
float share_of(const Placement& placement, const BandSplats& splats, float x, float y);

/// Calls place(galaxy, own) for each galaxy, with those splats of a block that are its own, and takes what it
/// placed.
template <class Block, class Place>
void place_by_galaxy(const Placement& placement, Block& block, const Place& place) {
    if (placement.galaxies.size() == 1) return place(placement.galaxies.front(), block);
    for (const GalaxyBody& galaxy : placement.galaxies) {
        Block own;
        int from[Block::size];
        for (int i = 0; i < block.count; ++i) {
            if (&placement.galaxy_at(block.x[i], block.y[i], block.random[i]) != &galaxy) continue;
            from[own.count] = i;
            copy_splat(block, i, own, own.count++);
        }
        if (own.count > 0) place(galaxy, own);
        for (int k = 0; k < own.count; ++k) copy_splat(own, k, block, from[k]);
    }
}

/// Fills z and distance from x, y, random and even; splats of fine bands that belong to a knot take its
/// depth.
void place(const Placement& placement, const BandSplats& splats, PlacedBlock& block);

/// The same without knots and without the relief or the walls that the depths are about.
void place_freely(const Placement& placement, const BandSplats& splats, PlacedBlock& block);

/// Fills z of what is small in a galaxy's disk, from x, y and random, as of the second finest band.
void place_small_in_galaxy(const Placement& placement, const GalaxyBody& galaxy, PlacedBlock& block);

}  // namespace astrosplat
