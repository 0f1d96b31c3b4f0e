// The galaxies of a picture as its scene says they lie, or as they are found. In: a picture's light and what
// the scene says of its structure. Out: bodies, with what the picture tells of each place.
#pragma once

#include "bodies/galaxy_body.h"
#include "bodies/galaxy_light.h"
#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

/// How the galaxies of a picture lie: as many as the scene lists, or one; where it says "auto", as they are
/// found in `light` (RGB, linear, >= 0, without a margin). Says at detail level what was found, and where
/// that is a guess.
std::vector<GalaxyPlane> galaxy_planes(const Image& light, const StructureParams& params);

/// The first of them, and the share of the light at each place that is its own; empty where it is alone.
struct OwnLight {
    GalaxyPlane plane;
    Image share;
};
OwnLight first_galaxy(const Image& light, const StructureParams& params);

/// What galaxies_of() found in one light for the scene before, where a hand changes the scene: the next one
/// finds only what differs.
struct GalaxySight {
    struct Galaxy {
        GalaxyPlane plane;  // of one near side
        bool only_spheroid = false;
        Image share;
        GalaxyLight gaussians;
        Image roughness;
        double rough = 0.0;
        Image invented;  // of invented_plane(); empty: none was asked for yet
    };
    bool coarse = false;              // fitted at half the size, four times as quickly
    Image to_fit;                     // empty: nothing was asked for yet
    std::vector<glm::dvec2> centers;  // that are seen
    std::vector<Galaxy> galaxies;
};

/// Their bodies, in texels of the picture with a margin of so many around `width` texels, which `light`
/// shows, perhaps smaller. `thicker`: than they are by themselves. `sight`: of the same light; may be null.
std::vector<GalaxyBody> galaxies_of(const Image& light, const StructureParams& params, double thicker,
                                    std::int64_t width, std::int64_t margin_px, std::uint32_t seed,
                                    GalaxySight* sight = nullptr);

}  // namespace astrosplat
