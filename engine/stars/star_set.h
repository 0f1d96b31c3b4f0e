// A star catalogue as a set, and the light of stars: their colour from the colour index B-V, their flux from
// the magnitude. In: stars by right ascension, declination, distance and magnitude. Out: a SplatSet whose
// colours are the stars' light as it arrives at the layer's origin, summed over all pixels. And random stars
// around a path, as such a set, of what kinds of stars there are.
#pragma once

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "splats/splat_set.h"
#include "stars/catalogue.h"

namespace astrosplat {

inline constexpr double ln10 = 2.302585092994046;

/// Kelvin, of a star of that B-V: F. J. Ballesteros, "New insights into black bodies", EPL 97 (2012) 34008,
/// eq. 14. Falls with B-V; for B-V above -0.67.
double star_temperature(double color_index);
/// B-V of a temperature, K: the same formula, solved.
double color_index_of(double kelvin);

/// Linear Rec. 709 of a black body's light, for temperatures above 0: Planck's law weighed with the colour
/// matching functions of CIE 1931 as C. Wyman, P.-P. Sloan and P. Shirley fit them ("Simple analytic
/// approximations to the CIE XYZ color matching functions", JCGT 2/2, 2013, section 2.2), from 380 to 780 nm.
/// Channels below 0, of colours that no screen shows, become 0; then the luminance is made 1.
glm::dvec3 black_body_color(double kelvin);

/// The colours of many stars, from a table in steps of 0.01 magnitudes.
class StarColors {
  public:
    StarColors();
    /// B-V is clamped to -0.4..5; without one it is 0.65, the Sun's.
    glm::dvec3 operator()(const std::optional<double>& color_index) const;

  private:
    std::vector<glm::dvec3> table_;
};

/// Where a star without a known distance is placed, scene units: what the renderer takes for infinitely far.
inline constexpr double star_infinity = 1e18;
/// The farthest that a star is placed otherwise.
inline constexpr double farthest_star = 1e12;

struct StarScale {
    double unit = 1.0;        // scene units per parsec
    double limit = 12.0;      // magnitude; fainter stars are left out
    double zero_point = 4.0;  // magnitude of a star of flux 1
};

/// Counts of a catalogue's stars by what became of them.
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

// ---- random stars: everything is a hash of (seed, id, purpose)

/// The properties of a star that do not depend on its place.
struct StarKind {
    double absolute_magnitude = 0.0;    // at 10 parsec
    std::optional<double> color_index;  // B-V
};

/// Of a catalogue's stars not fainter than `limit` those whose distance is known, each as likely as the
/// others: magnitudes and colours go together as they do there.
std::vector<StarKind> kinds_of(const StarCatalogue& catalogue, double limit);

/// Main-sequence stars of 0.1 to 30 solar masses m, equally likely ones: as many as E. E. Salpeter, "The
/// luminosity function and stellar evolution", ApJ 121 (1955) 161, finds, dN/dm ~ m^-2.35. Their luminosity
/// is m^3.5 and their radius m^0.8 of the Sun's, whose absolute magnitude is 4.83 and whose temperature 5772
/// K; B-V is star_temperature's.
std::vector<StarKind> main_sequence();

/// The union of balls of that radius around the points of straight parts.
struct StarTube {
    std::vector<glm::dvec3> path;  // at least one point, scene units
    double radius = 10.0;          // scene units, > 0
};

/// Leaves out points of a path that lies within `tolerance` of what is left.
std::vector<glm::dvec3> simplified_path(std::span<const glm::dvec3> path, double tolerance);

/// `count` stars, evenly in the tube's volume; id 0, 1, ... `kinds` holds at least one. scale.limit is not
/// used. The same bits for any thread count; the first n stars are those of a smaller count.
/// Throws Cancelled.
SplatSet random_stars(const StarTube& tube, std::span<const StarKind> kinds, std::int64_t count,
                      std::uint32_t seed, const StarScale& scale, const Progress& progress = {});

}  // namespace astrosplat
