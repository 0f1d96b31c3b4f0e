#include "bodies/galaxies.h"

#include <fmt/format.h>

#include <glm/vec2.hpp>

#include "bodies/galaxy_fit.h"
#include "core/log.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

// What the scene says of one galaxy, where it says it.
GalaxyPlane as_told(const GalaxyParams& told, const GalaxyPlane& found, double height_over_width) {
    GalaxyPlane plane = found;
    constexpr double nearly_edge_on_deg = 89.9;  // a plane that is a line has no place for what is seen on it
    if (told.inclination) plane.inclination_deg = std::min(*told.inclination, nearly_edge_on_deg);
    if (told.center) {
        plane.x = told.center->x;
        plane.y = (1.0 - told.center->y) * height_over_width;
    }
    if (told.position_angle) {
        const double turns = *told.position_angle / 180.0;
        plane.angle = real::pi * (turns - std::floor(turns));
    }
    if (told.near_side) {
        const double from_axis = real::radians(*told.near_side) - plane.angle;
        plane.near_side = real::sin(from_axis) >= 0.0 ? 1 : -1;
    }
    return plane;
}

bool needs_fit(const GalaxyParams& told) {
    const bool flat = told.inclination && *told.inclination == 0.0;
    return !flat && !(told.inclination && told.position_angle && told.center && told.near_side);
}

// A picture's galaxies: what the scene says of each, the light that is its own, and how it lies.
struct PictureGalaxies {
    std::vector<GalaxyParams> told;
    const Image& to_fit;
    std::vector<Image> shares;
    std::vector<GalaxyPlane> planes;
};

GalaxyPlane plane_in(const PictureGalaxies& galaxies, std::size_t k, glm::dvec2 center) {
    const GalaxyParams& told = galaxies.told[k];
    GalaxyPlane plane;
    plane.x = center.x;
    plane.y = center.y;
    if (!needs_fit(told)) return plane;
    const GalaxyFit fit = fit_galaxy(galaxies.to_fit, galaxies.shares[k]);
    const bool taken = told.inclination || !is_unsure(fit);
    log_detail("a galaxy by its light: " + words_of(fit) +
               (taken ? "" : "; so it lies in the picture's plane"));
    plane = fit.plane;
    if (!taken) plane.inclination_deg = 0.0;
    return plane;
}

// `light`: of that sight.
PictureGalaxies galaxies_in(GalaxySight& sight, const Image& light, const StructureParams& params) {
    if (sight.to_fit.pixels.empty()) {
        sight.to_fit = light_to_fit(light);
        sight.centers = galaxy_centers(sight.to_fit);
        if (sight.coarse) sight.to_fit = at_half_size(sight.to_fit);
    }
    PictureGalaxies galaxies{params.galaxies, sight.to_fit, {}, {}};
    if (galaxies.told.empty()) galaxies.told.push_back(params.galaxy);
    const double height_over_width = double(light.height) / double(light.width);
    const std::vector<glm::dvec2>& found = sight.centers;
    std::vector<glm::dvec2> centers;
    for (std::size_t k = 0; k < galaxies.told.size(); ++k) {
        const std::optional<glm::dvec2>& told = galaxies.told[k].center;
        centers.push_back(told ? glm::dvec2(told->x, (1.0 - told->y) * height_over_width)
                               : found[std::min(k, found.size() - 1)]);
    }
    galaxies.shares = shares_of(galaxies.to_fit, centers);
    for (std::size_t k = 0; k < centers.size(); ++k)
        galaxies.planes.push_back(
            as_told(galaxies.told[k], plane_in(galaxies, k, centers[k]), height_over_width));
    return galaxies;
}

// The share of each pixel, where it is lit, by which the logarithm of the light differs from the mean of two
// neighbours along the major axis (across it, a disk that is seen from the edge changes by itself). Channel
// 1: whether it is lit.
Image differences(const Image& light, const GalaxyPlane& plane) {
    constexpr double apart_px = 10.0, noise_px = 2.0;  // of a neighbour; of the blur against noise
    // Lit is what, blurred, has that share of nearly all of the light and of its top: else sky is measured.
    constexpr double wide_px = 12.0, lit_share = 0.1, nearly_all = 0.98, share_of_top = 0.04;
    constexpr float dark_sky = 0.01f;  // added to light
    Image logarithm = brightest_channel(light);
    const Image wide = gaussian_blur(logarithm, wide_px);
    for (float& value : logarithm.pixels) value = shared::as_log(value + dark_sky);
    logarithm = gaussian_blur(logarithm, noise_px);
    const auto lit =
        float(std::max(lit_share * percentile({wide.pixels.begin(), wide.pixels.end()}, nearly_all),
                       share_of_top * double(std::ranges::max(wide.pixels))));
    const auto dx = float(apart_px * real::cos(plane.angle)), dy = float(-apart_px * real::sin(plane.angle));
    Image away = make_image(light.width, light.height, 2);
    for_each_pixel(wide, [&](std::int64_t x, std::int64_t y) {
        if (!(*wide.at(x, y) > lit)) return;
        const float px = float(x) + 0.5f, py = float(y) + 0.5f;
        const float around =
            0.5f * (bilinear(logarithm, 0, px + dx, py + dy) + bilinear(logarithm, 0, px - dx, py - dy));
        away.at(x, y)[0] = std::fabs(*logarithm.at(x, y) - around);
        away.at(x, y)[1] = 1.0f;
    });
    return away;
}

// How rough a galaxy's light is about each place: 0 where it is as smooth as a lenticular's or a comet's
// (mean differences of .013 and .018), 1 as six spirals' (.05 to .15).
Image roughness_of(const Image& light, const GalaxyPlane& plane, const Image& to_fit) {
    constexpr std::int64_t width = 960;  // px: INCLINED's pictures
    constexpr float smooth = 0.013f, rough = 0.06f;
    constexpr double about_px = 20.0;
    const Image mean = gaussian_blur(differences(reduced_to_width(light, width), plane), about_px);
    const Image local = made_by_pixel(mean, 1, [&](const float* m, float* to) {
        *to = std::clamp((m[0] / std::max(m[1], 1e-3f) - smooth) / (rough - smooth), 0.0f, 1.0f);
    });
    return reduced_by_area(local, to_fit.width, to_fit.height);
}

// How much of a galaxy is rough, of its light: up to .24 in a lenticular by the noise of its sky and by what
// lies around it, .45 and more in spirals.
double rough_share(const Image& light, const Image& roughness) {
    constexpr double smooth = 0.15, rough = 0.4;
    double sum = 0.0, all = 1e-30;
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        sum += double(light.pixels[i]) * double(roughness.pixels[i]);
        all += double(light.pixels[i]);
    }
    return std::clamp((sum / all - smooth) / (rough - smooth), 0.0, 1.0);
}

// What the picture tells of each place of a galaxy: fields of the size of the light that was fitted.
void set_fields(const Image& to_fit, double texels, double offset, GalaxyBody& body) {
    constexpr float lit_light = 0.03f;                  // at which all points are the galaxy's
    constexpr float expected = 1.2f;                    // of the smooth galaxy's light, that is not above it
    constexpr float most_in_clouds = 0.5f;              // the rest keeps the disk whole: INCLINED 9
    constexpr float dark_sky = 0.02f, sky_fade = 1.5f;  // INCLINED 2: where all is halo
    constexpr double soft_px = 6.0, wide_px = 12.0, at_width = 960.0;  // of INCLINED's pictures
    constexpr float noise = 0.01f;                                     // added to light that divides
    const Image soft = gaussian_blur(to_fit, soft_px * double(to_fit.width) / at_width),
                wide = gaussian_blur(to_fit, wide_px * double(to_fit.width) / at_width);
    body.spheroid = unfilled_image(to_fit.width, to_fit.height, 1);
    body.excess = unfilled_image(to_fit.width, to_fit.height, 1);
    body.lit = unfilled_image(to_fit.width, to_fit.height, 1);
    for_each_pixel(to_fit, [&](std::int64_t x, std::int64_t y) {
        const auto texel = [&](std::int64_t px) { return float((double(px) + 0.5) * texels + offset); };
        const GalaxyLightAt light = light_at(body, texel(x), texel(y));
        const float sum = light.disk + light.spheroid, f = light.spheroid / std::max(sum, 1e-12f);
        const float sky = body.hidden * std::clamp(sky_fade - *wide.at(x, y) / dark_sky, 0.0f, 1.0f);
        *body.spheroid.at(x, y) = f + sky * (1.0f - f);
        *body.excess.at(x, y) = most_in_clouds * *body.roughness.at(x, y) * (1.0f - f) *
                                std::clamp(1.0f - expected * sum / (*soft.at(x, y) + noise), 0.0f, 1.0f);
        *body.lit.at(x, y) = std::clamp(*wide.at(x, y) / lit_light, 0.0f, 1.0f);
    });
    body.to_field = float(1.0 / texels);
    body.field_begins = float(offset);
}

}  // namespace

std::vector<GalaxyPlane> galaxy_planes(const Image& light, const StructureParams& params) {
    GalaxySight sight;
    return galaxies_in(sight, light, params).planes;
}

OwnLight first_galaxy(const Image& light, const StructureParams& params) {
    GalaxySight sight;
    PictureGalaxies galaxies = galaxies_in(sight, light, params);
    const bool alone = galaxies.planes.size() == 1;
    return {galaxies.planes.front(), alone ? Image() : std::move(galaxies.shares.front())};
}

namespace {

// As `sight` has it from before, where it is the same.
GalaxySight::Galaxy galaxy_seen(GalaxySight& sight, const Image& light, const PictureGalaxies& galaxies,
                                std::size_t k) {
    GalaxyPlane plane = galaxies.planes[k];
    plane.near_side = 1;  // of which nothing here depends
    const bool only_spheroid = galaxies.told[k].bulge == 1.0;
    if (k < sight.galaxies.size()) {
        GalaxySight::Galaxy& before = sight.galaxies[k];
        if (before.plane == plane && before.only_spheroid == only_spheroid &&
            before.share.pixels == galaxies.shares[k].pixels)
            return std::move(before);
    }
    GalaxySight::Galaxy seen{plane, only_spheroid, galaxies.shares[k], {}, {}, 0.0, {}};
    seen.gaussians = light_of_galaxy(galaxies.to_fit, seen.share, plane, only_spheroid);
    seen.roughness = roughness_of(light, plane, galaxies.to_fit);
    seen.rough = rough_share(galaxies.to_fit, seen.roughness);
    return seen;
}

}  // namespace

std::vector<GalaxyBody> galaxies_of(const Image& light, const StructureParams& params, double thicker,
                                    std::int64_t width, std::int64_t margin_px, std::uint32_t seed,
                                    GalaxySight* sight) {
    GalaxySight own;
    if (!sight) sight = &own;
    PictureGalaxies galaxies = galaxies_in(*sight, light, params);
    std::vector<GalaxySight::Galaxy> seen;
    for (std::size_t k = 0; k < galaxies.planes.size(); ++k)
        seen.push_back(galaxy_seen(*sight, light, galaxies, k));
    sight->galaxies = std::move(seen);
    const double texels = double(width) / double(galaxies.to_fit.width);
    std::vector<GalaxyBody> bodies;
    for (std::size_t k = 0; k < galaxies.planes.size(); ++k) {
        const GalaxyPlane& plane = galaxies.planes[k];
        const std::optional<double> bulge = galaxies.told[k].bulge;
        GalaxySight::Galaxy& found = sight->galaxies[k];
        GalaxyBody body = make_galaxy_body(found.gaussians, plane,
                                           {thicker, params.flare, bulge, found.rough}, double(width));
        log_detail(
            fmt::format("a galaxy of {:.0f} texels, what is small in it {:.1f} thick; {:.0f} % rough, {:.0f} "
                        "% of its light a spheroid's",
                        body.radius, body.thickness, 100.0 * found.rough, 100.0 * found.gaussians.bulge));
        body.center += float(margin_px);
        body.roughness = found.roughness;
        set_fields(galaxies.to_fit, texels, double(margin_px), body);
        if (galaxies.planes.size() > 1) body.share = std::move(galaxies.shares[k]);
        if (body.hidden > 0.0f) {
            if (found.invented.pixels.empty())
                found.invented = invented_plane(body.radius, seed + std::uint32_t(k));
            const auto strength = float(params.spiral * double(body.hidden));
            body.plane =
                made_by_pixel(found.invented, 1, [&](const float* p, float* to) { *to = strength * *p; });
        }
        bodies.push_back(std::move(body));
    }
    return bodies;
}

}  // namespace astrosplat
