// Patches of saturated pixels, judged by shape and by the fall of the light around them.
#include "prepare/saturated_stars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/real.h"
#include "core/sorting.h"

namespace astrosplat {
namespace {

constexpr std::size_t fewest_pixels = 9;
constexpr double widest_core_px = 60.0;
constexpr double longest = 2.5;          // of a core's box, over its other side
constexpr double fallen_share = 0.5;     // of the saturation, below which the light is beside a core
constexpr double misfit_share = 0.15;    // of the saturation, that the fit of the wings may leave
constexpr double highest = 300.0;        // of a core, over the saturation
constexpr double spike_strength = 4.0;   // of a ray, over the usual one
constexpr double farthest_spike = 10.0;  // over the core's radius
constexpr int rays = 72;
constexpr int narrow = 3;  // rays to either side that a spike stands out of

double brightness(const Image& image, double x, double y) {
    const auto i = std::clamp<std::int64_t>(static_cast<std::int64_t>(x), 0, image.width - 1);
    const auto j = std::clamp<std::int64_t>(static_cast<std::int64_t>(y), 0, image.height - 1);
    const float* const p = image.at(i, j);
    return static_cast<double>(p[0] + p[1] + p[2]) / 3.0;
}

// Brightness around a place, a value a ray.
std::vector<double> ring(const Image& image, double x, double y, double radius) {
    std::vector<double> values;
    for (int i = 0; i < rays; ++i) {
        const double angle = 2.0 * real::pi * i / rays;
        values.push_back(brightness(image, x + radius * real::cos(angle), y + radius * real::sin(angle)));
    }
    return values;
}

PictureStar core_of(const PixelPart& part, std::int64_t width, double noise) {
    PictureStar star;
    for (const std::int64_t i : part.pixels) {
        star.x += static_cast<double>(i % width) + 0.5;
        star.y += static_cast<double>(i / width) + 0.5;
    }
    const auto count = static_cast<double>(part.pixels.size());
    star.x = star.seen_x = star.x / count;
    star.y = star.seen_y = star.y / count;
    star.core_px = std::sqrt(count / real::pi);
    star.saturated = true;
    star.noise = star.pixel_noise = noise;
    return star;
}

bool is_round_patch(const PixelPart& part, const PictureStar& star) {
    const auto w = static_cast<double>(part.box.width), h = static_cast<double>(part.box.height);
    return part.pixels.size() >= fewest_pixels && star.core_px <= widest_core_px &&
           std::max(w, h) <= longest * std::min(w, h);
}

bool falls_off(const Image& image, const PictureStar& star) {
    const std::vector<double> at = ring(image, star.x, star.y, star.core_px);
    const std::vector<double> beside = ring(image, star.x, star.y, 2.0 * star.core_px + 3.0);
    const double far = percentile(ring(image, star.x, star.y, 4.0 * star.core_px + 8.0), 0.5);
    const double level = percentile(at, 0.5) - far;
    return level > 0.0 && percentile(beside, 0.7) - far < fallen_share * level;
}

// The shape whose wings fit best; false where none does.
bool fit_wings(const Image& image, const PixelMask& saturated, PictureStar& star) {
    const StarWidths widths{0, std::max(2.0, 1.5 * star.core_px), 1.0};
    PictureStar best = star;
    double least = std::numeric_limits<double>::infinity();
    for (int shape = 0; shape < star_shapes; ++shape) {
        PictureStar with = star;
        with.profile = {widths.fwhm_px, shape};
        if (!fit_star(image, saturated, widths, with)) continue;
        const double misfit = shape_misfit(image, saturated, with, {widths.fwhm_px, 0});
        if (with.mean_amplitude() > highest || misfit >= least) continue;
        least = misfit;
        best = with;
    }
    if (!std::isfinite(least) || best.misfit > misfit_share) return false;
    star = best;
    return true;
}

void mark_disc(PixelMask& mask, double x, double y, double radius) {
    const auto reach = static_cast<std::int64_t>(radius) + 1;
    const auto cx = static_cast<std::int64_t>(x), cy = static_cast<std::int64_t>(y);
    for (std::int64_t j = std::max<std::int64_t>(0, cy - reach); j <= std::min(mask.height - 1, cy + reach);
         ++j)
        for (std::int64_t i = std::max<std::int64_t>(0, cx - reach);
             i <= std::min(mask.width - 1, cx + reach); ++i)
            if (std::hypot(static_cast<double>(i) + 0.5 - x, static_cast<double>(j) + 0.5 - y) <= radius)
                mask.at(i, j) = 1;
}

// How much each ray stands out of those a little to its sides at one distance.
std::vector<double> excess(const std::vector<double>& around) {
    std::vector<double> out;
    for (int i = 0; i < rays; ++i) {
        const auto at = [&](int k) { return around[static_cast<std::size_t>((i + k + rays) % rays)]; };
        out.push_back(at(0) - std::max(at(-narrow), at(narrow)));
    }
    return out;
}

double median_size(std::vector<double> values) {
    for (double& value : values) value = std::fabs(value);
    return percentile(std::move(values), 0.5);
}

// Follows a ray outward while it stands out by at least `least`.
void mark_spike(const Image& without, const PictureStar& star, int ray, double start, double least,
                PixelMask& mask) {
    const double angle = 2.0 * real::pi * ray / rays, c = real::cos(angle), s = real::sin(angle);
    int faint = 0;
    const double end = farthest_spike * star.core_px + 15.0;
    for (double radius = start; radius < end && faint < 4; radius += 1.0) {
        const double x = star.x + radius * c, y = star.y + radius * s, side = 4.0;
        const double beside = std::max(brightness(without, x - side * s, y + side * c),
                                       brightness(without, x + side * s, y - side * c));
        faint = brightness(without, x, y) - beside < least ? faint + 1 : 0;
        mark_disc(mask, x, y, 1.5 + 0.03 * radius);
    }
}

}  // namespace

PixelMask saturated_pixels(const Image& image, double level) {
    PixelMask mask = make_mask(image.width, image.height);
    if (!std::isfinite(level)) return mask;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        const float* const p = image.pixels.data() + i * static_cast<std::size_t>(image.channels);
        mask.pixels[i] = static_cast<double>(std::max({p[0], p[1], p[2]})) >= level;
    }
    return mask;
}

std::vector<PictureStar> take_saturated_stars(Image& image, const PixelMask& saturated, double noise) {
    std::vector<PictureStar> stars;
    for (const PixelPart& part : connected_parts(saturated)) {
        PictureStar star = core_of(part, saturated.width, noise);
        if (is_round_patch(part, star) && falls_off(image, star) && fit_wings(image, saturated, star))
            stars.push_back(star);
    }
    for (const PictureStar& star : stars) add_star(image, star, -1.0f);
    return stars;
}

void mark_core_and_spikes(const Image& without, const PictureStar& star, PixelMask& mask) {
    mark_disc(mask, star.x, star.y, 1.3 * star.core_px + 2.0);
    std::vector<double> strength(rays, 0.0);
    const double start = 1.3 * star.core_px + 2.0, length = 2.0 * star.core_px + 4.0;
    for (double step = 0.0; step < length; step += 1.0) {
        const std::vector<double> out = excess(ring(without, star.x, star.y, start + 2.0 + step));
        for (std::size_t i = 0; i < strength.size(); ++i) strength[i] += out[i] / length;
    }
    const double least = spike_strength * median_size(strength);
    for (int i = 0; i < rays; ++i) {
        const auto at = [&](int k) { return strength[static_cast<std::size_t>((i + k + rays) % rays)]; };
        const double opposite = std::max({at(rays / 2 - 1), at(rays / 2), at(rays / 2 + 1)});
        if (at(0) > least && opposite > 0.5 * least)
            mark_spike(without, star, i, start, std::max(2.0 * star.noise, 0.2 * at(0)), mask);
    }
}

}  // namespace astrosplat
