#include "stars/star_set.h"

#include <glm/common.hpp>

#include "core/color.h"
#include "core/memory.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr double lowest = -0.4, highest = 5.0, step = 0.01;  // B-V
constexpr double unknown = 0.65;
constexpr double first_nm = 380.0, nm = 5.0;
constexpr std::size_t wavelengths = 81;

// One lobe of Wyman et al., whose width is another on either side of its peak.
double lobe(double wavelength_nm, double peak_nm, double below, double above) {
    const double t = (wavelength_nm - peak_nm) * (wavelength_nm < peak_nm ? below : above);
    return real::exp(-0.5 * t * t);
}

glm::dvec3 color_matching(double w) {
    return {0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
                0.065 * lobe(w, 501.1, 0.0490, 0.0382),
            0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
            1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

using MatchingTable = std::array<glm::dvec3, wavelengths>;

MatchingTable make_matching_table() {
    MatchingTable table;
    for (std::size_t i = 0; i < wavelengths; ++i) table[i] = color_matching(first_nm + nm * double(i));
    return table;
}

// Of a black body, up to a factor: 1 / (w^5 (e^(c2 / wT) - 1)), c2 in nm K (CODATA 2018).
double planck(double wavelength_nm, double kelvin) {
    constexpr double c2 = 1.438776877e7;
    const double micrometre = wavelength_nm / 1000.0, square = micrometre * micrometre;
    return 1.0 / (square * square * micrometre * (real::exp(c2 / (wavelength_nm * kelvin)) - 1.0));
}

// XYZ to linear Rec. 709 with white D65 (IEC 61966-2-1).
glm::dvec3 rec709(const glm::dvec3& xyz) {
    return {3.2406255 * xyz.x - 1.5372080 * xyz.y - 0.4986286 * xyz.z,
            -0.9689307 * xyz.x + 1.8757561 * xyz.y + 0.0415175 * xyz.z,
            0.0557101 * xyz.x - 0.2040211 * xyz.y + 1.0569959 * xyz.z};
}

constexpr double largest_flux = 1e18;  // squares and sums stay finite in 32 bits

}  // namespace

double star_temperature(double color_index) {
    return 4600.0 * (1.0 / (0.92 * color_index + 1.7) + 1.0 / (0.92 * color_index + 0.62));
}

double color_index_of(double kelvin) {
    const double t = kelvin / 4600.0, b = 2.32 * t - 2.0, c = 1.054 * t - 2.32;
    return (std::sqrt(b * b - 4.0 * t * c) - b) / (2.0 * t) / 0.92;
}

glm::dvec3 black_body_color(double kelvin) {
    glm::dvec3 xyz(0.0);
    static const MatchingTable matching = make_matching_table();
    for (std::size_t i = 0; i < wavelengths; ++i)
        xyz += planck(first_nm + nm * double(i), kelvin) * matching[i];
    const glm::dvec3 light = glm::max(rec709(xyz / xyz.y), glm::dvec3(0.0));
    return light / luminance(light.x, light.y, light.z);
}

StarColors::StarColors() {
    const int last = int(std::lround((highest - lowest) / step));
    for (int i = 0; i <= last; ++i) table_.push_back(black_body_color(star_temperature(lowest + i * step)));
}

glm::dvec3 StarColors::operator()(const std::optional<double>& color_index) const {
    const double at = (std::clamp(color_index.value_or(unknown), lowest, highest) - lowest) / step;
    const auto i = std::min(std::size_t(at), table_.size() - 2);
    return glm::mix(table_[i], table_[i + 1], at - double(i));
}

glm::dvec3 star_direction(double ra_deg, double dec_deg) {
    const double a = real::radians(ra_deg), d = real::radians(dec_deg);
    return {real::cos(d) * real::cos(a), real::sin(d), -(real::cos(d) * real::sin(a))};
}

double star_flux(double magnitude, double zero_point) {
    return real::exp(-0.4 * ln10 * (magnitude - zero_point));
}

glm::vec3 star_light(const glm::dvec3& color, double magnitude, double zero_point) {
    return glm::vec3(color * std::min(star_flux(magnitude, zero_point), largest_flux));
}

SplatSet empty_star_set(std::int64_t count) {
    const auto size = std::size_t(count);
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
    SplatSet set = empty_star_set(std::int64_t(bright.size()));
    std::int64_t infinite = 0;
    for (std::size_t i = 0; i < bright.size(); ++i) {
        const CatalogueStar& star = *bright[i];
        const double distance = star.distance_pc * scale.unit;
        const bool known = distance > 0.0 && distance <= farthest_star;
        const glm::dvec3 direction = star_direction(star.ra_deg, star.dec_deg);
        set.position[i] = glm::vec3(direction * (known ? distance : star_infinity));
        set.color[i] = star_light(colors(star.color_index), star.magnitude, scale.zero_point);
        set.id[i] = std::uint64_t(star.row);
        if (!known) ++infinite;
    }
    if (counts) *counts = {set.size(), std::int64_t(catalogue.stars.size()) - set.size(), infinite};
    return set;
}

}  // namespace astrosplat
