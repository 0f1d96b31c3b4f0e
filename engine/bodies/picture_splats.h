// The dots of a picture, in its own space: texels, x to the right, y up, z towards the viewer, the origin in
// the middle. In: bands and stars. Out: dots that show the picture from the front, but for what hides what
// (front_fit.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bodies/bands.h"
#include "bodies/picture_light.h"
#include "bodies/placement.h"
#include "bodies/stars.h"
#include "core/progress.h"
#include "splats/shaded_splats.h"

namespace astrosplat {

/// Dots [begin, end) of one size.
struct DotRange {
    std::int64_t begin = 0, end = 0;
    float sigma = 0.0f;  // texels; of stars: of most of them
};

struct PictureSplats {
    ShadedSplats
        splats;  // id: band, 254 for dust or 255 for stars from bit 48 on, size from 40, lattice cell
    Buffer<float> distance;        // texels from the middle of the layer
    std::vector<DotRange> ranges;  // of those that shine
    bool absorbs = false;          // there is dust: dots of colours below 0 (blend.glsl)
};

/// Takes the memory of so many dots at once, which are more than there are.
void reserve_dots(PictureSplats& set, std::int64_t count);

/// Makes room for more dots, whose values are not set.
void resize_dots(PictureSplats& set, std::int64_t count);

/// How a picture's brightness m becomes opacity, 1 - e^-tau = kappa m^p (DEPTH 5).
struct Opacity {
    float power = 0.55f, density = 0.75f;
    /// Optical depth of the column of a pixel.
    float depth_of(float brightest, float alpha) const;
};

/// Radius of a dot of the default falloff, in its sigmas; the integral of its footprint over 2 pi sigma^2;
/// and its variance along an axis over sigma^2.
inline constexpr float radius_sigmas = 3.0f;
inline constexpr float footprint_share = 0.9494f;
inline constexpr double footprint_variance = 0.8802;

/// Share of a band's dots that are kept where its light's brightest channel is `amplitude`, and the picture's
/// `brightest`.
float kept_share(float amplitude, float brightest, const BandDots& dots);

/// Adds a band's dots. `picture` is the whole picture's light, whose brightness decides the opacity.
void add_band(const Image& band, const BandDots& dots, const Image& brightest, const Image& alpha,
              const Placement& placement, const Opacity& opacity, PictureSplats& out);

/// Adds one dot a star of about one size, at a depth of the layer's own distribution. `first_number`: in ids.
void add_stars(std::span<const Star> stars, std::uint32_t first_number, const Placement& placement,
               const Opacity& opacity, PictureSplats& out);

}  // namespace astrosplat
