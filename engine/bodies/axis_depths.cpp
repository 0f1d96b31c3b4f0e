#include "bodies/axis_depths.h"

#include <glm/vec2.hpp>

#include "core/real.h"
#include "core/shared_maths.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr std::int64_t lines_across = 240;

// Its rings about a line of sight, lengths in picture widths.
struct Sight {
    const AxisFit& fit;
    double u, v;          // across the axis and along it from its middle
    double cosine, sine;  // of the tilt

    Sight(const AxisFit& about, double x, double y)
        : fit(about),
          cosine(real::cos(real::radians(fit.tilt_deg))),
          sine(real::sin(real::radians(fit.tilt_deg))) {
        const double c = real::cos(fit.angle), s = real::sin(fit.angle), dx = x - fit.x, dy = fit.y - y;
        u = dx * s - dy * c;
        v = dx * c + dy * s;
    }

    // In pixels of the rings' image, from its top left corner.
    glm::vec2 at(double z) const {
        const double cell = 2.0 * fit.reach / double(fit.rings.width);
        const double height = v * cosine + z * sine, out = z * cosine - v * sine;
        return {float((height + fit.reach) / cell), float(std::sqrt(u * u + out * out) / cell)};
    }
};

bool crosses(const Image& rings, const glm::vec2& p) {
    return p.x >= 0.0f && p.x <= float(rings.width) && p.y <= float(rings.height);
}

glm::vec3 color_at(const Image& rings, const glm::vec2& p) {
    if (!crosses(rings, p)) return glm::vec3(0.0f);
    const LinearSample sample(rings, p.x, p.y);
    return {sample.of(rings, 0), sample.of(rings, 1), sample.of(rings, 2)};
}

// Where a line crosses no ring, or what it shows is no ring's: near what shines, and thinly everywhere.
struct Elsewhere {
    Image near;         // one channel
    float thin = 0.0f;  // in the middle
};
Elsewhere elsewhere_of(const Image& rings) {
    // Little beside rings, which have their light to themselves; much beside nothing: shares of blurred light
    // and of that of bright rings.
    constexpr double blur = 0.08, near_share = 0.02, thin_share = 2e-4, bright_ones = 0.99;
    Image sum = mean_of_channels(rings);
    const double bright = percentile({sum.pixels.begin(), sum.pixels.end()}, bright_ones);
    Elsewhere e{gaussian_blur(sum, blur * double(rings.width)), float(thin_share * bright) + 1e-12f};
    for (float& value : e.near.pixels) value *= float(near_share);
    return e;
}

constexpr int sight_samples = 192;  // along a line of sight

// Depths of a line by the light behind: each sample's light is spread evenly over its part of the line.
void set_depths(const Sight& sight, const Elsewhere& elsewhere, double farthest, double width, float* depths,
                float* seen) {
    constexpr float thin_depth = 0.06f;  // picture widths
    constexpr float outermost =
        0.004f;  // of a line's light on either side: what is beyond is next to nothing
    std::array<float, sight_samples + 1> behind{};
    const double step = 2.0 * farthest / sight_samples;
    glm::vec3 all(0.0f);
    for (int k = 0; k < sight_samples; ++k) {
        const double z = (k + 0.5) * step - farthest;
        const glm::vec2 p = sight.at(z);
        const glm::vec3 light = color_at(sight.fit.rings, p);
        const float from_middle = float(z) / thin_depth;
        float near = crosses(sight.fit.rings, p) ? bilinear(elsewhere.near, 0, p.x, p.y) : 0.0f;
        near += elsewhere.thin * shared::as_exp(-0.5f * from_middle * from_middle);
        all += light;
        behind[std::size_t(k) + 1] = behind[std::size_t(k)] + (light.x + light.y + light.z) / 3.0f + near;
    }
    for (int c = 0; c < 3; ++c) seen[c] = all[c] * float(step);
    int k = 0;
    for (int i = 0; i <= AxisDepths::steps; ++i) {
        const float share = std::clamp(float(i) / float(AxisDepths::steps), outermost, 1.0f - outermost);
        const float wanted = share * behind[sight_samples];
        while (k + 1 < sight_samples && behind[std::size_t(k) + 1] < wanted) ++k;
        const float part = behind[std::size_t(k) + 1] - behind[std::size_t(k)];
        const double t = part > 0.0f ? double((wanted - behind[std::size_t(k)]) / part) : 0.5;
        depths[i] = float(((k + std::clamp(t, 0.0, 1.0)) * step - farthest) * width);
    }
}

LinearSample line_at(const AxisDepths& depths, const Image& lines, float x, float y) {
    const float share = float(lines.width) / float(depths.width);
    return {lines, x * share, y * share};
}

}  // namespace

float AxisDepths::depth(float x, float y, float share) const {
    const float at = std::clamp(share, 0.0f, 1.0f) * float(steps);
    const int step = std::min(int(at), steps - 1);
    const LinearSample line = line_at(*this, depths, x, y);
    const float lower = line.of(depths, step), upper = line.of(depths, step + 1);
    return lower + (at - float(step)) * (upper - lower);
}

float AxisDepths::residue_at(float x, float y) const { return line_at(*this, residue, x, y).of(residue); }

glm::vec3 AxisDepths::tint(float x, float y, float z) const {
    constexpr float least = 0.4f, most = 2.5f;
    const Sight sight(fit, double(x) / width, double(y) / width);
    const glm::vec3 here = color_at(fit.rings, sight.at(double(z) / width));
    const LinearSample line = line_at(*this, seen, x, y);
    const glm::vec3 all(line.of(seen, 0), line.of(seen, 1), line.of(seen, 2));
    const float mean_here = here.x + here.y + here.z, mean_all = all.x + all.y + all.z;
    if (mean_here <= 0.0f || mean_all <= 0.0f) return glm::vec3(1.0f);
    // Faint rings are noise: as far as they are, the colour is that of the line.
    constexpr float long_as = 4.0f;  // of a line that shines evenly, times as long as the rings reach
    const float even = mean_all / (long_as * float(fit.reach)), sure = mean_here / (mean_here + even);
    glm::vec3 factor(1.0f);
    for (int c = 0; c < 3; ++c)
        if (all[c] > 0.0f) {
            const float found = std::clamp(here[c] / mean_here * (mean_all / all[c]), least, most);
            factor[c] += sure * (found - 1.0f);
        }
    return factor;
}

AxisDepths make_axis_depths(AxisFit fit, const Image& light, std::int64_t width) {
    AxisDepths made;
    made.width = double(width > 0 ? width : light.width);
    const Image shown = reduced_to_width(light, lines_across);
    const std::int64_t w = shown.width, h = shown.height;
    made.depths = make_image(w, h, AxisDepths::steps + 1);
    made.seen = make_image(w, h, 3);
    made.residue = make_image(w, h, 1);
    const Elsewhere elsewhere = elsewhere_of(fit.rings);
    const double cell = 2.0 * fit.reach / double(fit.rings.width),
                 farthest = std::hypot(fit.reach, cell * double(fit.rings.height));
    for_each_pixel(shown, [&](std::int64_t x, std::int64_t y) {
        const double texels = 1.0 / double(w);
        const Sight sight(fit, (double(x) + 0.5) * texels, (double(y) + 0.5) * texels);
        set_depths(sight, elsewhere, farthest, made.width, made.depths.at(x, y), made.seen.at(x, y));
        const float *p = shown.at(x, y), *q = made.seen.at(x, y);
        float all = 1e-9f, rings = 0.0f;
        for (int c = 0; c < 3; ++c) {
            all += p[c];
            rings += std::min(p[c], q[c]);
        }
        *made.residue.at(x, y) = std::clamp(1.0f - rings / all, 0.0f, 1.0f);
    });
    made.fit = std::move(fit);
    return made;
}

}  // namespace astrosplat
