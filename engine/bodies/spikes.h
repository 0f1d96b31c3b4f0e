// Diffraction spikes of a picture's bright stars, and these stars (DETAIL 5). In: linear light. Out: the
// light without them, and what was taken out, which is to lie in one plane a star: as a part of the nebula
// each spike would become a wire over its relief. All crosses of a picture lie at one angle: what looks like
// a spike is none where no others agree.
#pragma once

#include <glm/vec3.hpp>

#include "bodies/stars.h"
#include "core/image.h"

namespace astrosplat {

struct Spikes {
    std::vector<RoundStar> stars;   // the brightest of their peaks first
    std::vector<SpikeLight> light;  // by rows of squares
    std::vector<Star> gaussians;    // what the stars are but for that, by their bodies
    int arms = 0;                   // of each cross: 4, or 6 of a mirror of hexagons; 0: there are none
    double angle = 0.0;             // radians from x towards y, of one of them, below 2 pi / arms
};

/// Takes spikes and their stars out of `light`. `times`: pixels along a side of each that the picture had
/// before it was enlarged. `before`: another image of that light, where there is one; null: a copy is made.
/// The same bits with any number of threads; without crosses the light stays as it is.
Spikes take_spikes(Image& light, int times = 1, const Image* before = nullptr);

}  // namespace astrosplat
