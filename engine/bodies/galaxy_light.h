// A galaxy's light as a sum of Gaussians, spheroid and disk apart, where it is known how the galaxy lies, and
// the dust before it (INCLINED 1, 2). In: linear light. Out: Gaussians, and the ring of dust of a lane.
#pragma once

#include <glm/vec2.hpp>

#include "bodies/gaussian_sum.h"
#include "core/image.h"

namespace astrosplat {

/// How a galaxy lies in a picture.
struct GalaxyPlane {
    double x = 0.5, y = 0.5;       // centre, from the top left corner in picture widths (both)
    double angle = 0.0;            // of the major axis, radians from right counter-clockwise as seen, [0, pi)
    double inclination_deg = 0.0;  // 0 face-on .. 89
    int near_side = 1;             // 1: what lies counter-clockwise of the major axis is nearer; else -1
    bool operator==(const GalaxyPlane&) const = default;
};

/// A spheroid's axis ratio of its own, where it is not seen (INCLINED 2).
inline constexpr double usual_roundness = 0.7;

/// One Gaussian of the sum, as it is seen: exp(-(u^2 + (v / ratio)^2) / (2 sigma^2)).
struct GaussianLight {
    double sigma = 0.0;  // along the major axis, picture widths
    double flux = 0.0;   // sigma^2 ratio times the light in its middle
};

struct GalaxyLight {
    std::vector<GaussianLight> disk, spheroid;
    double disk_ratio = 1.0, spheroid_ratio = 1.0;  // as seen
    double bulge = 0.0;                             // share of the spheroid in the light within the picture
    std::optional<double> ring;                     // of dust, seen as a lane: its radius, picture widths
};

/// Light that dust and young stars change least, so small that it is fitted at once: one channel, with
/// compact light replaced by the median around it, but not within a bright core. `light`: RGB, or grey.
Image light_to_fit(const Image& light);

/// For each centre (picture widths, as GalaxyPlane has it) the share of the light that belongs to it, of the
/// size of light_to_fit(): flooded from the brightest on. Of one centre: 1 everywhere.
std::vector<Image> shares_of(const Image& to_fit, const std::vector<glm::dvec2>& centers);

/// The Gaussians of a galaxy of which it is known how it lies; `share`: as shares_of() has it.
/// `only_spheroid`: it has no disk, so all of them are the spheroid's. The same bits with any number of
/// threads.
GalaxyLight light_of_galaxy(const Image& to_fit, const Image& share, const GalaxyPlane& plane,
                            bool only_spheroid = false);

/// How a plane is seen in an image of that width: its ellipses, with a disk of the usual thickness.
Ellipses ellipses_of(const GalaxyPlane& plane, std::int64_t width);

/// Of a disk of the usual thickness: the apparent axis ratio, and degrees.
double ratio_of_inclination(double degrees);
double inclination_of_ratio(double ratio);

/// Mean misfit of the best sum for these ellipses; what is darker than the sum counts little. Right ones have
/// .006 to .06, what is no galaxy .17.
double misfit(const Ellipses& e, const Image& light, const Image& share, const std::vector<double>& sigmas);

/// Both at half the size.
Ellipses at_half_size(Ellipses e);
Image at_half_size(const Image& image);

/// Ratios within what the fit can tell: .04 to .98, a spheroid's rounder than the disk's.
Ellipses bounded(Ellipses e);

/// What the dust tells of a disk of these ellipses.
struct DustSeen {
    std::optional<double> angle, inclination_deg, ring_px;  // of a lane, where there is one
    double more_below = 0.0;  // -1..1: of the light it takes, on the side clockwise of the major axis
};
DustSeen dust_seen(const Ellipses& e, const Image& to_fit, const Image& share);

}  // namespace astrosplat
