#include "bodies/galaxy_fit.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "bodies/gaussian_sum.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "detect/peaks.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

using Five = std::array<double, 5>;

struct Corner {
    Five place{};
    double value = 0.0;
};

// The least of a function of five numbers, downhill from a corner and one step along each of them (Nelder and
// Mead 1965, Computer Journal 7, 308).
Five least_downhill(const std::function<double(const Five&)>& value_of, int evaluations) {
    std::array<Corner, 6> corners{};
    for (std::size_t i = 0; i < 5; ++i) corners[i + 1].place[i] = 1.0;
    for (Corner& corner : corners) corner.value = value_of(corner.place);
    int left = evaluations - 6;
    const auto try_at = [&](const Five& middle, const Five& from, double share) {
        Corner corner;
        for (std::size_t i = 0; i < 5; ++i) corner.place[i] = middle[i] + share * (from[i] - middle[i]);
        corner.value = value_of(corner.place);
        --left;
        return corner;
    };
    constexpr double alike = 1e-5;  // values, of misfits of .006 and more: nothing is left to find
    while (left > 0) {
        std::ranges::stable_sort(corners, {}, &Corner::value);
        if (corners[5].value - corners[0].value < alike) break;
        Five middle{};
        for (std::size_t k = 0; k < 5; ++k)
            for (std::size_t i = 0; i < 5; ++i) middle[i] += 0.2 * corners[k].place[i];  // the mean of five
        Corner& worst = corners[5];
        const Corner mirrored = try_at(middle, worst.place, -1.0);
        if (mirrored.value < corners[0].value) {
            const Corner farther = try_at(middle, worst.place, -2.0);
            worst = farther.value < mirrored.value ? farther : mirrored;
        } else if (mirrored.value < corners[4].value) {
            worst = mirrored;
        } else {
            const bool outside = mirrored.value < worst.value;
            const Corner nearer = try_at(middle, outside ? mirrored.place : worst.place, 0.5);
            if (nearer.value < std::min(mirrored.value, worst.value)) {
                worst = nearer;
                continue;
            }
            for (std::size_t k = 1; k < 6; ++k) corners[k] = try_at(corners[0].place, corners[k].place, 0.5);
        }
    }
    return std::ranges::min_element(corners, {}, &Corner::value)->place;
}

struct FoundEllipses {
    Ellipses ellipses;
    double loss = 0.0;
};

// The best of 8 angles and three ratios about the brightest place (INCLINED 1).
FoundEllipses first_guess(const Image& light, const Image& share,
                          const std::function<double(const Ellipses&)>& loss) {
    constexpr double smooth_share = 0.02;                         // of the width
    constexpr double usual_spheroid = 0.75, least_rounder = 0.1;  // its ratio, and over the disk's
    Image weighed = light;
    for (std::size_t p = 0; p < weighed.pixels.size(); ++p) weighed.pixels[p] *= share.pixels[p];
    const Image smooth = gaussian_blur(weighed, smooth_share * double(light.width));
    const auto top = std::ranges::max_element(smooth.pixels) - smooth.pixels.begin();
    Ellipses start{double(top % light.width), double(top / light.width)};
    FoundEllipses best{start, 1e300};
    for (int k = 0; k < 8; ++k) {
        for (const double q : {0.12, 0.35, 0.7}) {
            start.angle = real::pi * k / 8.0;
            start.disk = q;
            start.spheroid = std::max(usual_spheroid, q + least_rounder);
            if (const double value = loss(start); value < best.loss) best = {start, value};
        }
    }
    return best;
}

FoundEllipses find_ellipses(const Image& light, const Image& share) {
    const Image half = at_half_size(light), half_share = at_half_size(share);
    // INCLINED 1; the finest of the widths is too fine for half the size.
    const double finest = 1.2, widest = 1.1 * double(light.width);
    constexpr int widths = 13, evaluations = 160;
    std::vector<double> sigmas = geometric(0.5 * finest, 0.5 * widest, widths);
    sigmas.erase(sigmas.begin());
    const auto loss = [&](const Ellipses& e) { return misfit(at_half_size(e), half, half_share, sigmas); };
    const FoundEllipses best = first_guess(light, share, loss);
    constexpr Five step{3.0, 3.0, 0.12, 0.08,
                        0.1};  // px, radians and ratios: about as far as the guess is off
    const auto stepped = [&](const Five& d) {
        const Ellipses& e = best.ellipses;
        return bounded({e.x + d[0] * step[0], e.y + d[1] * step[1], e.angle + d[2] * step[2],
                        e.disk + d[3] * step[3], e.spheroid + d[4] * step[4]});
    };
    const Five least = least_downhill([&](const Five& d) { return loss(stepped(d)); }, evaluations);
    return {stepped(least), loss(stepped(least))};
}

// Radius about a place within which half of the light above the sky is, px.
double half_light_radius(const Image& above, double x0, double y0) {
    std::vector<std::pair<double, double>> pixels;  // radius, light
    double all = 0.0, sum = 0.0;
    for (std::int64_t y = 0; y < above.height; ++y)
        for (std::int64_t x = 0; x < above.width; ++x) {
            const auto light = double(*above.at(x, y));
            pixels.emplace_back(std::hypot(double(x) - x0, double(y) - y0), light);
            all += light;
        }
    std::ranges::sort(pixels);
    for (const auto& [radius, light] : pixels)
        if ((sum += light) >= 0.5 * all) return radius;
    return 1.0;
}

// A ring of a disk that is seen as these ellipses: its light, and the parts of it that go as the cosine and
// the sine of twice the angle.
struct SampledRing {
    double mean = 0.0, as_cos = 0.0, as_sin = 0.0;
    bool seen = false;  // all of it lies within the picture
};
constexpr int sectors = 64;

SampledRing ring_of(const Image& above, const Ellipses& e, double radius) {
    const double c = real::cos(e.angle), s = real::sin(e.angle);
    SampledRing ring;
    int inside = 0;
    for (int k = 0; k < sectors; ++k) {
        const double turn = 2.0 * real::pi * k / sectors;
        const double u = radius * real::cos(turn), v = e.disk * radius * real::sin(turn);
        const double x = e.x + u * c - v * s, y = e.y + u * s + v * c;
        inside += x >= 0.0 && y >= 0.0 && x <= double(above.width - 1) && y <= double(above.height - 1);
        const auto light = double(bilinear(above, 0, float(x) + 0.5f, float(y) + 0.5f));
        ring.mean += light;
        ring.as_cos += light * real::cos(2.0 * turn);
        ring.as_sin += light * real::sin(2.0 * turn);
    }
    ring.seen = inside >= sectors - 1;
    return ring;
}

// How much of a disk's light goes as cos(2 angle) with one phase at all radii, 0..1, where its plane is seen
// as ellipses of this ratio and angle: 0 for the true ones, for arms wind, and turn out of phase from radius
// to radius (Garcia-Gomez and Athanassoula 1991, A&AS 89, 159).
struct Harmonic {
    double strength = 1e300;  // where too little of the disk lies within the picture
    double seen = 0.0;        // share of the rings that lie within the picture
};
Harmonic even_harmonic(const Image& above, const Ellipses& e, double half_light) {
    constexpr int rings = 22, least_rings = 8;
    constexpr double first = 0.4, last = 2.5;  // half-light radii
    constexpr double faint = 0.02;             // of the brightest: fainter rings do not count more
    const double brightest = double(std::ranges::max(above.pixels));
    double as_cos = 0.0, as_sin = 0.0;
    int counted = 0;
    for (; counted < rings; ++counted) {
        const double radius =
            half_light / std::sqrt(e.disk) * (first + (last - first) * counted / (rings - 1.0));
        const SampledRing ring = ring_of(above, e, radius);
        if (!ring.seen) break;
        const double weight = 1.0 / (ring.mean + faint * sectors * brightest);
        as_cos += ring.as_cos * weight;
        as_sin += ring.as_sin * weight;
    }
    if (counted < least_rings) return {};
    return {std::hypot(as_cos, as_sin) / counted, counted / double(rings)};
}

// The plane by its arms. Measured on 67 galaxies against literature: where it is less than 64 degrees it is
// better than the fit, which takes two open arms or a bar for an inclination (all: median error 3.1 degrees,
// 8 off by over 12; the fit alone: 5.0 and 22).
struct ByArms {
    Ellipses ellipses;
    double seen = 0.0;  // share of the rings
};
std::optional<ByArms> by_arms(const Image& light, Ellipses e) {
    constexpr double noise_px = 1.5, sky_share = 0.1, ratio_step = 0.025;
    Image above = gaussian_blur(light, noise_px);
    const auto sky = float(percentile({above.pixels.begin(), above.pixels.end()}, sky_share));
    for (float& value : above.pixels) value = std::max(0.0f, value - sky);
    const double half_light = half_light_radius(above, e.x, e.y);
    constexpr int ratios = 29, angles = 36;  // .3 to 1; 5 degrees
    const auto ellipses = [e](std::size_t k) {
        Ellipses tried = e;
        tried.disk = 1.0 - ratio_step * double(k / angles);
        tried.angle = real::pi * double(k % angles) / angles;
        return tried;
    };
    std::vector<Harmonic> found(ratios * angles);
    parallel_each(found.size(), 8,
                  [&](std::size_t k) { found[k] = even_harmonic(above, ellipses(k), half_light); });
    const auto best = std::ranges::min_element(found, {}, &Harmonic::strength);
    if (best->seen == 0.0) return {};
    return ByArms{bounded(ellipses(std::size_t(best - found.begin()))), best->seen};
}

// The fit's ellipses, mended by the arms where these tell more. Inner rings alone, which is all that a frame
// that cuts the galaxy leaves, are those of the bulge, and count less.
Ellipses mended_by_arms(const Image& light, Ellipses e, double& differs_deg) {
    constexpr double arms_tell = 64.0, light_tells = 76.0;  // degrees
    constexpr double farthest_arms = 74.0;                  // that by_arms() tries
    const std::optional<ByArms> arms = by_arms(light, e);
    if (!arms) return e;
    const double by_light = inclination_of_ratio(e.disk), by_arms = inclination_of_ratio(arms->ellipses.disk);
    if (by_arms < farthest_arms) differs_deg = std::fabs(by_light - by_arms);
    if (by_arms >= arms_tell || by_light >= light_tells) return e;
    constexpr double enough_rings = 0.5;
    if (arms->seen > enough_rings) e.angle = arms->ellipses.angle;
    e.disk = ratio_of_inclination(std::lerp(by_light, by_arms, arms->seen));
    return bounded(e);
}

}  // namespace

GalaxyFit fit_galaxy(const Image& to_fit, const Image& share) {
    constexpr double most_deg = 89.0;
    const FoundEllipses found = find_ellipses(to_fit, share);
    GalaxyFit fit;
    fit.misfit = found.loss;
    Ellipses e = mended_by_arms(to_fit, found.ellipses, fit.inclination_differs_deg);
    const DustSeen dust = dust_seen(e, to_fit, share);
    e.angle = dust.angle.value_or(e.angle);
    // Rows count down, angles as seen: what is below the axis there is clockwise of it.
    const double seen_angle = -e.angle;
    if (dust.inclination_deg) fit.inclination_differs_deg = 0.0;  // a lane is sure
    GalaxyPlane& plane = fit.plane;
    plane.angle = seen_angle - real::pi * std::floor(seen_angle / real::pi);
    plane.inclination_deg = std::min(dust.inclination_deg.value_or(inclination_of_ratio(e.disk)), most_deg);
    const bool flipped = std::llround((seen_angle - plane.angle) / real::pi) % 2 != 0;
    plane.near_side = (dust.more_below >= 0.0) == flipped ? 1 : -1;
    plane.x = (e.x + 0.5) / double(to_fit.width);
    plane.y = (e.y + 0.5) / double(to_fit.width);
    fit.near_sure = std::fabs(dust.more_below);
    fit.bulge = light_of_galaxy(to_fit, share, plane).bulge;
    return fit;
}

// Peaks of wide light that are parted from every brighter one by a saddle: galaxies of their own (INCLINED
// 1).
std::vector<glm::dvec2> galaxy_centers(const Image& to_fit) {
    constexpr double smooth = 0.03, least_peak = 0.2, deepest_saddle = 0.35, farthest = 0.6, reach = 0.06;
    constexpr int steps = 60;
    const auto width = double(to_fit.width);
    const Image light = gaussian_blur(to_fit, smooth * width);
    const float top = std::ranges::max(light.pixels);
    auto peaks = found_by_rows(light, 0, [&](std::int64_t x, std::int64_t y) -> std::optional<glm::dvec2> {
        const double off = std::hypot(double(x) - 0.5 * width, double(y) - 0.5 * double(light.height));
        if (*light.at(x, y) <= float(least_peak) * top || off > farthest * width) return {};
        if (!is_peak(light, x, y, std::int64_t(reach * width))) return {};
        return glm::dvec2(double(x) + 0.5, double(y) + 0.5);
    });
    const auto at = [&](glm::dvec2 p) { return bilinear(light, 0, float(p.x), float(p.y)); };
    std::ranges::stable_sort(peaks, [&](glm::dvec2 a, glm::dvec2 b) { return at(a) > at(b); });
    std::vector<glm::dvec2> centers;
    for (const glm::dvec2 peak : peaks) {
        const bool parted = std::ranges::all_of(centers, [&](glm::dvec2 brighter) {
            float saddle = at(peak);
            for (int i = 0; i <= steps; ++i)
                saddle = std::min(saddle, at(glm::mix(peak, brighter * width, double(i) / steps)));
            return saddle < float(deepest_saddle) * at(peak);
        });
        if (parted) centers.push_back(peak / width);
    }
    if (centers.empty()) {
        const auto brightest = std::ranges::max_element(light.pixels) - light.pixels.begin();
        centers.push_back(
            glm::dvec2(double(brightest % light.width) + 0.5, double(brightest / light.width) + 0.5) / width);
    }
    return centers;
}

std::vector<GalaxyFit> fit_galaxies(const Image& light, Galaxies which) {
    const Image to_fit = light_to_fit(light);
    std::vector<glm::dvec2> centers = galaxy_centers(to_fit);
    if (which == Galaxies::one) centers.resize(1);
    std::vector<GalaxyFit> fits;
    for (const Image& share : shares_of(to_fit, centers)) fits.push_back(fit_galaxy(to_fit, share));
    return fits;
}

bool is_unsure(const GalaxyFit& fit) {
    constexpr double most_misfit = 0.12, farthest_outside = 0.1;  // INCLINED 8
    const GalaxyPlane& p = fit.plane;
    return fit.misfit > most_misfit || std::min(p.x, p.y) < -farthest_outside || p.x > 1.0 + farthest_outside;
}

std::string words_of(const GalaxyFit& fit) {
    constexpr double least_sure = 0.15;  // INCLINED 8
    // Of 67 galaxies this is said of half of those that are off by more than 12 degrees.
    constexpr double most_differs_deg = 10.0, most_misfit = 0.05;
    const bool unsure = fit.inclination_differs_deg > most_differs_deg || fit.misfit > most_misfit;
    return fmt::format("{:.0f} degrees{}{}", fit.plane.inclination_deg, unsure ? ", unsure" : "",
                       fit.near_sure < least_sure ? "; which side is nearer is a guess" : "");
}

}  // namespace astrosplat
