// Random stars around a path. In: the path, how far from it stars lie, and what kinds of stars there are.
// Out: a SplatSet as star_set.h makes them of catalogues. Everything is a hash of (seed, id, purpose).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "splats/splat_set.h"
#include "stars/star_set.h"

namespace astrosplat {

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
/// used. The same bits for any thread count; the first n stars are those of a smaller count. Throws
/// Cancelled.
SplatSet random_stars(const StarTube& tube, std::span<const StarKind> kinds, std::int64_t count,
                      std::uint32_t seed, const StarScale& scale, const Progress& progress = {});

}  // namespace astrosplat
