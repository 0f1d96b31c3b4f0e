// The dark details of a picture as dust that absorbs (DEPTH 2, 5). In: the picture's light and its bands'
// sum, and the splats that shine. Out: splats of colours below 0 on a torn sheet before the disk's middle.
#pragma once

#include "bodies/picture_splats.h"
#include "core/image.h"

namespace astrosplat {

/// Exponents of what dust lets through, r, g, b: more blue is lost.
inline constexpr glm::vec3 dust_exponents{0.8f, 1.0f, 1.35f};

/// Those of the dust of a picture: `dust_exponents`, and 1 where `light` is grey everywhere, as of a single
/// filter: nothing of it is redder than anything else.
glm::vec3 dust_exponents_of(const Image& light);

/// The light that reaches the viewer of a disk that shines as `emission`, so that at most `brightest` is seen
/// in any channel: the ratio of the brightest ones, .1 to 1; 1 where both are dark. One channel. The less,
/// the smaller the picture's `alpha` (one channel, or without pixels): what fades towards an edge is no dust.
Image transmittance_of(const Image& brightest, const Image& emission, const Image& alpha = {});

/// Share of its optical depth that a picture's dust has.
double dust_of(const StructureParams& params);

/// Splats a texel where it leaves so much, about.
float expected_dust_splats(float transmittance, double amount);

/// Texels from one splat of dust to the next.
inline constexpr float dust_spacing = 1.29099445f;

/// Fills z of dust from x, y, random and even, over the middle plane.
void place_dust(const Placement& placement, DepthBlock& block);

/// Adds the dust that, with the light of `out` partly before it and partly behind, leaves `transmittance`
/// of the whole. `amount`: share of its optical depth, 0 to 1; `exponents`: those of the picture.
void add_dust(const Image& transmittance, double amount, const glm::vec3& exponents,
              const Placement& placement, PictureSplats& out);

}  // namespace astrosplat
