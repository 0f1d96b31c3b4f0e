// Which way the galaxies in a picture lie (INCLINED 1). In: linear light. Out: each one's centre and angles,
// and how sure they are.
#pragma once

#include <glm/vec2.hpp>

#include "bodies/galaxy_light.h"
#include "core/image.h"

namespace astrosplat {

struct GalaxyFit {
    GalaxyPlane plane;
    double near_sure = 0.0;  // 0..1, by how much more light is absorbed on its near side; below .15 a guess
    double inclination_differs_deg = 0.0;  // between two ways to find it; more than 10 is unsure
    double misfit = 0.0;                   // right ones have .006 to .06, what is no galaxy .17
    double bulge = 0.0;                    // share of the spheroid in the light
};

/// One galaxy of a picture; `to_fit` and `share` as light_to_fit() and shares_of() have them. The same bits
/// with any number of threads.
GalaxyFit fit_galaxy(const Image& to_fit, const Image& share);

/// Middles of a picture's galaxies, the brightest first, as GalaxyPlane has them; at least one.
std::vector<glm::dvec2> galaxy_centers(const Image& to_fit);

/// All galaxies of a picture, the brightest first, or it as one. `light`: RGB, linear, >= 0.
enum class Galaxies { all, one };
std::vector<GalaxyFit> fit_galaxies(const Image& light, Galaxies which = Galaxies::all);

/// Whether it is so unsure how a galaxy lies that it is better taken for face-on (INCLINED 8).
bool is_unsure(const GalaxyFit& fit);

/// Such as "64 degrees, unsure; which side is nearer is a guess".
std::string words_of(const GalaxyFit& fit);

}  // namespace astrosplat
