#include "stars/star_set.h"

#include <algorithm>
#include <vector>

#include "core/memory.h"
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

glm::vec3 star_light(const glm::dvec3& color, double magnitude, double zero_point) {
    return glm::vec3(color * std::min(star_flux(magnitude, zero_point), largest_flux));
}

SplatSet empty_star_set(std::int64_t count) {
    const auto size = static_cast<std::size_t>(count);
    constexpr std::int64_t bytes = 2 * sizeof(glm::vec3) + 3 * sizeof(float) + sizeof(std::uint64_t);
    claim_memory(count * bytes, "stars");
    SplatSet set;
    set.stars = true;
    set.position.resize(size);
    set.color.resize(size);
    set.id.resize(size);
    set.alpha.assign(size, 1.0f);
    set.distance.assign(size, 0.0f);
    set.radius.assign(size, 0.0f);
    return set;
}

SplatSet star_set(const StarCatalogue& catalogue, const StarScale& scale, StarCounts* counts) {
    const StarColors colors;
    std::vector<const CatalogueStar*> bright;
    for (const CatalogueStar& star : catalogue.stars)
        if (star.magnitude <= scale.limit) bright.push_back(&star);
    SplatSet set = empty_star_set(static_cast<std::int64_t>(bright.size()));
    std::int64_t infinite = 0;
    for (std::size_t i = 0; i < bright.size(); ++i) {
        const CatalogueStar& star = *bright[i];
        const double distance = star.distance_pc * scale.unit;
        const bool known = distance > 0.0 && distance <= farthest_star;
        const glm::dvec3 direction = star_direction(star.ra_deg, star.dec_deg);
        set.position[i] = glm::vec3(direction * (known ? distance : star_infinity));
        set.color[i] = star_light(colors(star.color_index), star.magnitude, scale.zero_point);
        set.id[i] = static_cast<std::uint64_t>(star.row);
        if (!known) ++infinite;
    }
    if (counts)
        *counts = {set.size(), static_cast<std::int64_t>(catalogue.stars.size()) - set.size(), infinite};
    return set;
}

}  // namespace astrosplat
