// Patches of saturated pixels, judged by shape and by the fall of the light around them.
#include "prepare/star_removal.h"

#include "core/real.h"
#include "core/sorting.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr std::size_t fewest_pixels = 9;  // of a core
constexpr double widest_core_px = 60.0;   // its radius
constexpr double longest = 2.5;           // of a core's box, over its other side
constexpr double fallen_share = 0.5;      // of the light at a core's rim, below which it has fallen off
constexpr double fallen_rays = 0.7;       // share of the rays on which it has to
constexpr double narrowest_wings_px = 2.0, wings_radii = 1.5;  // width to begin with: at least, or core radii
constexpr double misfit_share = 0.15;    // of the saturation, that the fit of the wings may leave
constexpr double highest = 300.0;        // of a core, over the saturation
constexpr double spike_strength = 4.0;   // of a ray, over the usual one
constexpr double farthest_spike = 10.0;  // over the core's radius
// Places around a core, in its radii and px more: beside it and far from it; where spikes begin, and over how
// long they are looked for.
struct Away {
    double radii, px;
    double from(const PictureStar& star) const { return radii * star.core_px + px; }
};
constexpr Away beside_core{2.0, 3.0}, far_from_core{4.0, 8.0}, spike_start{1.3, 2.0}, spike_length{2.0, 4.0};
constexpr Away spike_end{farthest_spike, 15.0};
constexpr int rays = 72;                // around a core, on which its surroundings are looked at
constexpr int narrow = 3;               // rays to either side that a spike stands out of
constexpr double opposite_share = 0.5;  // of what is asked of a ray, that the one opposite must have
constexpr double least_spike_noise = 2.0,
                 least_spike_share = 0.2;  // of noise, of its strength: it ends below
constexpr int most_faint_px = 4;           // in a row, at which a spike ends
constexpr double spike_side_px = 4.0;      // from its middle to what it stands out of on either side
constexpr double first_strength_px = 2.0;  // from its start to where its strength is measured first
constexpr double spike_half_px = 1.5, spike_widening = 0.03;  // half its width, and more a px of distance

double brightness(const Image& image, double x, double y) {
    const auto i = std::clamp<std::int64_t>(std::int64_t(x), 0, image.width - 1);
    const auto j = std::clamp<std::int64_t>(std::int64_t(y), 0, image.height - 1);
    const float* const p = image.at(i, j);
    return double(p[0] + p[1] + p[2]) / 3.0;
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
        star.x += double(i % width) + 0.5;
        star.y += double(i / width) + 0.5;
    }
    const auto count = double(part.pixels.size());
    star.x = star.seen_x = star.x / count;
    star.y = star.seen_y = star.y / count;
    star.core_px = std::sqrt(count / real::pi);
    star.saturated = true;
    star.noise = star.pixel_noise = noise;
    return star;
}

bool is_round_patch(const PixelPart& part, const PictureStar& star) {
    const auto w = double(part.box.width), h = double(part.box.height);
    return part.pixels.size() >= fewest_pixels && star.core_px <= widest_core_px &&
           std::max(w, h) <= longest * std::min(w, h);
}

bool falls_off(const Image& image, const PictureStar& star) {
    const std::vector<double> at = ring(image, star.x, star.y, star.core_px);
    const std::vector<double> beside = ring(image, star.x, star.y, beside_core.from(star));
    const double far = percentile(ring(image, star.x, star.y, far_from_core.from(star)), 0.5);
    const double level = percentile(at, 0.5) - far;
    return level > 0.0 && percentile(beside, fallen_rays) - far < fallen_share * level;
}

// The shape whose wings fit best; false where none does.
bool fit_wings(const Image& image, const PixelMask& saturated, PictureStar& star) {
    const StarWidths widths{0, std::max(narrowest_wings_px, wings_radii * star.core_px), 1.0};
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
    for_each_within(mask, x, y, radius,
                    [&](std::int64_t i, std::int64_t j, double, double) { mask.at(i, j) = 1; });
}

// How much each ray stands out of those a little to its sides at one distance.
std::vector<double> excess(const std::vector<double>& around) {
    std::vector<double> out;
    for (int i = 0; i < rays; ++i) {
        const auto at = [&](int k) { return around[(i + k + rays) % rays]; };
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
    const double end = spike_end.from(star);
    for (double radius = start; radius < end && faint < most_faint_px; radius += 1.0) {
        const double x = star.x + radius * c, y = star.y + radius * s;
        const double beside = std::max(brightness(without, x - spike_side_px * s, y + spike_side_px * c),
                                       brightness(without, x + spike_side_px * s, y - spike_side_px * c));
        faint = brightness(without, x, y) - beside < least ? faint + 1 : 0;
        mark_disc(mask, x, y, spike_half_px + spike_widening * radius);
    }
}

}  // namespace

PixelMask saturated_pixels(const Image& image, double level) {
    PixelMask mask = make_mask(image.width, image.height);
    if (!std::isfinite(level)) return mask;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        const float* const p = image.pixels.data() + i * std::size_t(image.channels);
        mask.pixels[i] = double(std::max({p[0], p[1], p[2]})) >= level;
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
    mark_disc(mask, star.x, star.y, spike_start.from(star));
    std::vector<double> strength(rays, 0.0);
    const double start = spike_start.from(star), length = spike_length.from(star);
    for (double step = 0.0; step < length; step += 1.0) {
        const std::vector<double> out =
            excess(ring(without, star.x, star.y, start + first_strength_px + step));
        for (std::size_t i = 0; i < strength.size(); ++i) strength[i] += out[i] / length;
    }
    const double least = spike_strength * median_size(strength);
    for (int i = 0; i < rays; ++i) {
        const auto at = [&](int k) { return strength[(i + k + rays) % rays]; };
        const double opposite = std::max({at(rays / 2 - 1), at(rays / 2), at(rays / 2 + 1)});
        if (at(0) > least && opposite > opposite_share * least)
            mark_spike(without, star, i, start,
                       std::max(least_spike_noise * star.noise, least_spike_share * at(0)), mask);
    }
}

}  // namespace astrosplat
