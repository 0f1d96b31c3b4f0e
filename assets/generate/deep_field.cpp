// The sky around the demo objects: an equirectangular deep field of faint galaxies of all shapes, a few
// nearby ones, and foreground stars. Everything is strewn evenly over the sphere and widened by 1 /
// cos(latitude), so that nothing looks stretched from inside.
#include <algorithm>
#include <cmath>

#include "assets.h"
#include "canvas.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "noise.h"

namespace astrosplat::assets {
namespace {

constexpr int sky_width_px = 4096, sky_height_px = 2048;

struct Galaxy {
    glm::vec2 place_px;
    float widen;      // 1 / cos(latitude)
    float radius_px;  // half-light radius along the major axis
    float flattening;
    float turn;       // radians
    float steepness;  // Sersic index: 1 disk .. 4 elliptical
    glm::vec3 peak;   // at half-light radius
    float winding;    // of its two arms, either way round; 0: none
};

// Evenly over the sphere: longitude and sine of latitude are uniform. Caps of 2 degrees are left out.
glm::vec2 sky_place(unsigned seed, unsigned i, float& widen) {
    const float sine = 0.9994f * (2.0f * uniform(seed, i, 1) - 1.0f);
    const double latitude = real::asin(static_cast<double>(sine));
    widen = 1.0f / std::sqrt(1.0f - sine * sine);
    return {uniform(seed, i, 2) * sky_width_px,
            static_cast<float>(0.5 - latitude / real::pi) * static_cast<float>(sky_height_px)};
}

// Sersic profile, 1 at the half-light radius, with two faint arms where asked for.
float brightness(const Galaxy& g, float x, float y) {
    const float c = static_cast<float>(real::cos(static_cast<double>(g.turn)));
    const float s = static_cast<float>(real::sin(static_cast<double>(g.turn)));
    const float a = (x * c + y * s) / g.radius_px, b = (y * c - x * s) / (g.radius_px * g.flattening);
    const float r = std::sqrt(a * a + b * b + 0.01f);
    const float profile =
        shared::as_exp(-(2.0f * g.steepness - 0.33f) * (shared::as_pow(r, 1.0f / g.steepness) - 1.0f));
    if (g.winding == 0.0f) return profile;
    const double phase = 2.0 * real::atan2(static_cast<double>(b), static_cast<double>(a)) +
                         static_cast<double>(g.winding * shared::as_log(r));
    return profile * (1.0f + 0.45f * smoothstep(0.2f, 1.0f, r) * static_cast<float>(real::cos(phase)));
}

void add_galaxy(Canvas& sky, const Galaxy& g) {
    const float reach = g.radius_px * (g.steepness > 2.0f ? 7.0f : 4.5f) + 2.0f;
    const int y0 = std::max(0, static_cast<int>(g.place_px.y - reach));
    const int y1 = std::min(sky_height_px - 1, static_cast<int>(g.place_px.y + reach));
    const int half = std::min(sky_width_px / 2 - 1, static_cast<int>(reach * g.widen));
    for (int y = y0; y <= y1; ++y)
        for (int dx = -half; dx <= half; ++dx) {
            const int x = (static_cast<int>(g.place_px.x) + dx + sky_width_px) % sky_width_px;
            const float px = static_cast<float>(dx) / g.widen,
                        py = static_cast<float>(y) + 0.5f - g.place_px.y;
            const float fade = 1.0f - smoothstep(0.6f * reach, reach, std::sqrt(px * px + py * py));
            sky.at(x, y) += glm::vec4(g.peak * (fade * brightness(g, px, py)), 0.0f);
        }
}

void add_galaxies(Canvas& sky) {
    for (unsigned i = 0; i < 9000; ++i) {
        Galaxy g{};
        g.place_px = sky_place(701, i, g.widen);
        const float size =
            shared::as_pow(std::max(1e-4f, uniform(701, i, 3)), -1.0f / 2.1f);  // N(> size) ~ size^-2.1
        g.radius_px = std::min(0.60f * size, 4.6f);
        g.flattening = 0.22f + 0.75f * uniform(701, i, 4);
        g.turn = uniform(701, i, 5) * static_cast<float>(2.0 * real::pi);
        const bool elliptical = uniform(701, i, 6) < 0.3f;
        g.steepness = elliptical ? 3.2f : 1.0f;
        if (!elliptical && g.radius_px > 1.8f)
            g.winding = (uniform(701, i, 9) < 0.5f ? -1.0f : 1.0f) * (3.5f + 3.0f * uniform(701, i, 10));
        const float age = elliptical ? 0.75f + 0.25f * uniform(701, i, 7) : uniform(701, i, 7);
        const glm::vec3 tint =
            age < 0.5f ? shared::mix(glm::vec3(0.55f, 0.72f, 1.0f), glm::vec3(1.0f, 0.88f, 0.72f), 2.0f * age)
                       : shared::mix(glm::vec3(1.0f, 0.88f, 0.72f), glm::vec3(1.0f, 0.55f, 0.32f),
                                     2.0f * age - 1.0f);
        const float dim = shared::as_exp(0.8f * normal(701, i, 8));
        g.peak = tint * (0.012f * dim * (elliptical ? 0.5f : 1.0f));
        add_galaxy(sky, g);
    }
}

void add_stars(Canvas& sky) {
    for (unsigned i = 0; i < 2600; ++i) {
        float widen = 1.0f;
        const glm::vec2 place = sky_place(801, i, widen);
        if (widen > 3.0f) continue;  // a round glow would look stretched
        const float flux =
            std::min(9.0f, 0.05f * shared::as_pow(std::max(1e-5f, uniform(801, i, 3)), -1.0f / 1.1f));
        const float warmth = uniform(801, i, 4);
        const glm::vec3 tint =
            shared::mix(glm::vec3(0.75f, 0.86f, 1.0f), glm::vec3(1.0f, 0.80f, 0.58f), warmth);
        add_glow(sky, place, flux * tint, 0.58f + 0.10f * std::sqrt(flux));
    }
}

}  // namespace

void make_deep_field(const std::filesystem::path& folder) {
    Canvas sky = make_canvas(sky_width_px, sky_height_px);
    add_galaxies(sky);
    add_stars(sky);
    for (glm::vec4& pixel : sky.pixels) pixel = glm::vec4(asinh_curve(glm::vec3(pixel), 0.12f, 1.4f), 1.0f);
    save_jpeg(sky, folder / "textures/deep_field.jpg", 90);
}

}  // namespace astrosplat::assets
