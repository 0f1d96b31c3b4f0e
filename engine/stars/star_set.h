// A star catalogue as a set. In: stars by right ascension, declination, distance and magnitude. Out: a
// SplatSet whose colours are the stars' light as it arrives at the layer's origin, summed over all pixels.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>

#include "splats/splat_set.h"
#include "stars/catalogue.h"

namespace astrosplat {

/// Where a star without a known distance is placed, scene units: what the renderer takes for infinitely far.
inline constexpr double star_infinity = 1e18;
/// The farthest that a star is placed otherwise.
inline constexpr double farthest_star = 1e12;

struct StarScale {
    double unit = 1.0;        // scene units per parsec
    double limit = 12.0;      // magnitude; fainter stars are left out
    double zero_point = 4.0;  // magnitude of a star of flux 1
};

/// What became of a catalogue's stars.
struct StarCounts {
    std::int64_t kept = 0, too_faint = 0;
    std::int64_t infinite = 0;  // of those kept: at infinity, without a usable distance
};

/// Unit vector: x = cos d cos a, y = sin d, z = -cos d sin a. From inside, north up, east is to the left.
glm::dvec3 star_direction(double ra_deg, double dec_deg);

/// 10^(-0.4 (magnitude - zero_point)).
double star_flux(double magnitude, double zero_point);

/// The light of a star of that colour, which has luminance 1; finite whatever the magnitude.
glm::vec3 star_light(const glm::dvec3& color, double magnitude, double zero_point);

/// So many stars of alpha 1, distance and radius 0, whose places, colours and ids are still to be filled in.
SplatSet empty_star_set(std::int64_t count);

/// Alpha is 1, distance and radius 0, id the row. The luminance of a colour is the star's flux.
SplatSet star_set(const StarCatalogue& catalogue, const StarScale& scale, StarCounts* counts = nullptr);

}  // namespace astrosplat
