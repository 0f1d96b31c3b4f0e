#include "stars/star_set.h"

#include <algorithm>
#include <glm/common.hpp>

#include "core/real.h"
#include "stars/star_color.h"

namespace astrosplat {
namespace {

constexpr double largest_flux = 1e18;  // squares and sums stay finite in 32 bits

}  // namespace

glm::dvec3 star_direction(double ra_deg, double dec_deg) {
    const double a = real::radians(ra_deg), d = real::radians(dec_deg);
    return {real::cos(d) * real::cos(a), real::sin(d), -(real::cos(d) * real::sin(a))};
}

double star_flux(double magnitude, double zero_point) {
    constexpr double ln10 = 2.302585092994046;
    return real::exp(-0.4 * ln10 * (magnitude - zero_point));
}

SplatSet star_set(const StarCatalogue& catalogue, const StarScale& scale, StarCounts* counts) {
    const StarColors colors;
    StarCounts count;
    SplatSet set;
    for (const CatalogueStar& star : catalogue.stars) {
        if (star.magnitude > scale.limit) {
            ++count.too_faint;
            continue;
        }
        const double distance = star.distance_pc * scale.unit;
        const bool known = distance > 0.0 && distance <= farthest_star;
        const double flux = std::min(star_flux(star.magnitude, scale.zero_point), largest_flux);
        const glm::dvec3 direction = star_direction(star.ra_deg, star.dec_deg);
        set.position.push_back(glm::vec3(direction * (known ? distance : star_infinity)));
        set.color.push_back(glm::vec3(colors(star.color_index) * flux));
        set.id.push_back(static_cast<std::uint64_t>(star.row));
        if (!known) ++count.infinite;
    }
    set.stars = true;
    count.kept = set.size();
    set.alpha.assign(set.position.size(), 1.0f);
    set.distance.assign(set.position.size(), 0.0f);
    set.radius.assign(set.position.size(), 0.0f);
    if (counts) *counts = count;
    return set;
}

}  // namespace astrosplat
