// Which way the galaxies in a picture lie (INCLINED 1). In: linear light. Out: each one's centre and angles,
// and how sure they are.
#pragma once

#include <vector>

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

/// The galaxy that is the only one in the picture. `light`: RGB, linear, >= 0. The same bits with any number
/// of threads.
GalaxyFit fit_galaxy(const Image& light);

/// The galaxies in a picture, the brightest first; at least one.
std::vector<GalaxyFit> fit_galaxies(const Image& light);

/// Whether it is so unsure how a galaxy lies that it is better taken for face-on (INCLINED 8).
bool is_unsure(const GalaxyFit& fit);

}  // namespace astrosplat
