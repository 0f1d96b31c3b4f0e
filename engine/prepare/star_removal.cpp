// Subtraction, then the cores filled.
#include "prepare/star_removal.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "prepare/cells.h"

namespace astrosplat {
namespace {

constexpr double trusted_height = 6.0;  // of a profile over a pixel's noise: above, its pixels are filled
constexpr double least_trusted = 1.0;   // and below, they are what the picture shows
constexpr double too_dark = 2.0;        // times the noise: profiles were wider or higher than the star
constexpr double too_bright = 4.0;      // or narrower, near the star's middle
constexpr std::int64_t cell_px = 24;

// Pixels within `radius` of a star.
template <class Visit>
void for_each_near(const PictureStar& star, const PixelMask& mask, double radius, const Visit& visit) {
    const auto reach = static_cast<std::int64_t>(radius) + 1;
    const auto x = static_cast<std::int64_t>(star.x), y = static_cast<std::int64_t>(star.y);
    for (std::int64_t j = std::max<std::int64_t>(0, y - reach); j <= std::min(mask.height - 1, y + reach);
         ++j) {
        for (std::int64_t i = std::max<std::int64_t>(0, x - reach); i <= std::min(mask.width - 1, x + reach);
             ++i) {
            const double dx = static_cast<double>(i) + 0.5 - star.x,
                         dy = static_cast<double>(j) + 0.5 - star.y;
            if (dx * dx + dy * dy < radius * radius) visit(i, j, dx * dx + dy * dy);
        }
    }
}

// A pixel that the star's profile did not leave as its surroundings are.
bool stands_out(const Image& without, const Cells& cells, std::int64_t x, std::int64_t y, bool near) {
    for (int c = 0; c < 3; ++c) {
        const double u = static_cast<double>(x) + 0.5, v = static_cast<double>(y) + 0.5;
        const double level = interpolated(cells.level, cells.cell_px, u, v, c);
        const double noise = interpolated(cells.noise, cells.cell_px, u, v, c);
        const double away = static_cast<double>(without.at(x, y)[c]) - level;
        if (away < -too_dark * noise || (near && away > too_bright * noise)) return true;
    }
    return false;
}

void mark_distrusted(const Image& without, const Cells& cells, const PictureStar& star, PixelMask& mask) {
    const double share = star.pixel_noise / star.mean_amplitude();
    const double core = reach_of(star.profile, trusted_height * share);
    const double whole = std::min(reach_px(star), reach_of(star.profile, least_trusted * share));
    for_each_near(star, mask, std::max(core, whole), [&](std::int64_t x, std::int64_t y, double squared) {
        const bool near = squared < star.profile.fwhm_px * star.profile.fwhm_px;
        if (squared < core * core || stands_out(without, cells, x, y, near)) mask.at(x, y) = 1;
    });
}

void keep_above_zero(const Image& before, Image& after) {
    parallel_each(before.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < before.width; ++x)
            for (int c = 0; c < 3; ++c)
                after.at(x, y)[c] = std::max(after.at(x, y)[c], std::min(0.0f, before.at(x, y)[c]));
    });
}

double whole_flux(const PictureStar& star) { return star.flux(0) + star.flux(1) + star.flux(2); }

}  // namespace

StarRemoval remove_stars(const Image& image, const StarSettings& settings, const Progress& progress) {
    StarField field = find_stars(image, settings, progress);
    PixelMask& cores = field.covered;
    const Cells cells = measure_cells(field.image, cell_px);
    for (const PictureStar& star : field.stars) mark_distrusted(field.image, cells, star, cores);
    fill(field.image, cores, FillKind::texture, progress);
    keep_above_zero(image, field.image);
    std::stable_sort(field.stars.begin(), field.stars.end(), [](const PictureStar& a, const PictureStar& b) {
        return whole_flux(a) > whole_flux(b);
    });
    progress.at(1.0);
    return {std::move(field.image), std::move(field.stars)};
}

std::int64_t star_removal_bytes(const Image& image) {
    const std::int64_t floats = image.channels + 1 + 3 + 1;  // the result, brightness, sums and heights
    return image.width * image.height * (floats * static_cast<std::int64_t>(sizeof(float)) + 3);
}

}  // namespace astrosplat
