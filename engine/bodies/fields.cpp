#include "bodies/fields.h"

#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

// Lengths of DEPTH 4's measurements, in px of a picture 1920 wide: standard deviations of blurs.
constexpr double thickness_blur = 40.0;
constexpr double body_blur = 60.0, body_edge_blur = 30.0, relief_blur = 45.0, crease_blur = 10.0;
constexpr double finest_blur_steps = 10.0;  // of a field's pixels, that its blur is wide at least

// H(x, y) over H: on a dark sky, what the brightest light adds to that, and at most.
constexpr double thinnest = 0.55, bulge_adds = 1.65, bulge_power = 5.0, thickest = 2.2;
constexpr double bulge_percentile = 0.995;  // of the light, that counts as the brightest
constexpr double steepest_bulge = 0.3;

constexpr double body_from = 0.25, body_to = 0.96;  // percentiles of the light between which a body rises

double scaled(double length, const Image& image) { return length * double(image.width) / 1920.0; }

template <class Change>
void change_each(Image& image, const Change& change) {
    parallel_each(image.pixels.size(), 1 << 14,
                  [&](std::size_t i) { image.pixels[i] = float(change(image.pixels[i])); });
}

double field_percentile(const Image& field, double share) {
    return percentile({field.pixels.begin(), field.pixels.end()}, share);
}

Image of_field_size(const Image& brightest) {
    Image image = brightest;
    for (int i = 0; i < field_halvings(brightest); ++i) image = halved(image);
    return image;
}

// Texels a pixel of a field.
double field_step(const Image& brightest) { return double(1 << field_halvings(brightest)); }

// Lowers what rises above a neighbour by more than `steepest` a px: two sweeps of a chamfer distance
// transform, one from the top left and one from the bottom right.
void limit_slope(Image& image, double steepest) {
    const auto step = float(steepest);
    const float diagonal = step * 1.41421356f;
    const auto lower = [&](std::int64_t x, std::int64_t y, std::int64_t to) {
        float& here = *image.at(x, y);
        const auto by = [&](std::int64_t i, std::int64_t j, float rise) {
            if (i >= 0 && i < image.width && j >= 0 && j < image.height)
                here = std::min(here, *image.at(i, j) + rise);
        };
        by(x + to, y, step);
        by(x + to, y + to, diagonal);
        by(x, y + to, step);
        by(x - to, y + to, diagonal);
    };
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x) lower(x, y, -1);
    for (std::int64_t y = image.height - 1; y >= 0; --y)
        for (std::int64_t x = image.width - 1; x >= 0; --x) lower(x, y, 1);
}

}  // namespace

int field_halvings(const Image& brightest) {
    int halvings = 0;
    while (scaled(thickness_blur, brightest) >= finest_blur_steps * double(2 << halvings)) ++halvings;
    return halvings;
}

Image thickness_field(const Image& brightest, double height) {
    const double step = field_step(brightest);
    Image field = gaussian_blur(of_field_size(brightest), scaled(thickness_blur, brightest) / step);
    const double bright = std::max(1e-12, field_percentile(field, bulge_percentile));
    change_each(field, [&](double v) {
        const double bulge = bulge_adds * real::pow(std::max(0.0, v / bright), bulge_power);
        return height * std::min(thinnest + bulge, thickest);
    });
    limit_slope(field, steepest_bulge * step);
    return field;
}

Image relief_field(const Image& brightest, double depth, double steepest) {
    const double step = field_step(brightest);
    const auto blurred = [&](const Image& image, double length) {
        return gaussian_blur(image, scaled(length, brightest) / step);
    };
    Image field = blurred(of_field_size(brightest), body_blur);
    const double lo = field_percentile(field, body_from);
    const double span = std::max(1e-12, field_percentile(field, body_to) - lo);
    change_each(field, [&](double v) { return std::clamp((v - lo) / span, 0.0, 1.0); });
    field = blurred(field, body_edge_blur);
    change_each(field, [](double v) { return std::sqrt(std::max(0.0, v)); });
    field = blurred(field, relief_blur);
    const double highest = std::ranges::max(field.pixels);
    if (highest <= 0.0) return field;
    change_each(field, [&](double v) { return v / highest * depth; });
    limit_slope(field, steepest * step);
    return blurred(field, crease_blur);  // takes the chamfer's edges off
}

Image structure_field(const Image& brightest) {
    // Structure of 1 to 2 % of the width, where folds showed as spots on a reflection nebula's even light
    // (its deviation is .07; of pillars and filaments .15 to .3).
    constexpr double finest = 10.0, widest = 40.0, about = 120.0;
    constexpr double least_light = 0.02, least = 0.12, whole = 0.25;
    const double step = field_step(brightest);
    const auto blurred = [&](const Image& image, double length) {
        return gaussian_blur(image, scaled(length, brightest) / step);
    };
    Image field = of_field_size(brightest);
    const double floor = std::max(1e-12, least_light * field_percentile(field, bulge_percentile));
    change_each(field, [&](double v) { return real::log(std::max(0.0, v) + floor); });
    const Image wide = blurred(field, widest);
    field = blurred(field, finest);
    for (std::size_t i = 0; i < field.pixels.size(); ++i) {
        field.pixels[i] -= wide.pixels[i];
        field.pixels[i] *= field.pixels[i];
    }
    field = blurred(field, about);
    change_each(field, [&](double v) { return std::clamp(std::sqrt(std::max(0.0, v)) / whole, least, 1.0); });
    return field;
}

namespace {

// Found on the Crab and the Ring: the walls follow the outline of what is bright over wide areas. Redone on
// painted pictures by tests/numbers, as is what tells kinds of pictures apart.
constexpr std::int64_t longest_grid = 128;         // px, on which the equation is solved
constexpr double silhouette_blur = 20.0 / 1920.0;  // of the width
constexpr double sky_percentile = 0.02, bright_percentile = 0.96;
constexpr double silhouette_from = 0.04, silhouette_to = 0.13;  // of the range between them: its soft edge
constexpr float leak = 4.0f;                                    // outside of it, by which h falls off
constexpr int sweeps = 400;
constexpr double shell_blur = 0.005;  // of the width: takes corners off

// The light of wide areas, coarse enough to solve equations on.
struct SilhouetteGrid {
    Image light;
    std::vector<ImageSize> finer;  // from that of the fields on down, each half the one before
};

SilhouetteGrid silhouette_grid(const Image& brightest) {
    SilhouetteGrid grid{of_field_size(brightest), {}};
    grid.light = gaussian_blur(grid.light, silhouette_blur * double(grid.light.width));
    while (std::max(grid.light.width, grid.light.height) > longest_grid) {
        grid.finer.push_back({grid.light.width, grid.light.height});
        grid.light = halved(grid.light);
    }
    return grid;
}

// From 0 to 1 between two values, with even ends.
double smooth(double from, double to, double value) {
    return real::smoothstep(std::clamp((value - from) / (to - from), 0.0, 1.0));
}

// 1 where light is above a twelfth of its range, 0 where it is below, with a soft edge.
Image silhouette_of(Image light) {
    const double sky = field_percentile(light, sky_percentile);
    const double range = std::max(1e-12, field_percentile(light, bright_percentile) - sky);
    change_each(light, [&](double v) { return smooth(silhouette_from, silhouette_to, (v - sky) / range); });
    return light;
}

// The result on the grid, at the size of the fields.
Image to_field_size(Image coarse, const SilhouetteGrid& grid) {
    for (auto size = grid.finer.rbegin(); size != grid.finer.rend(); ++size)
        coarse = doubled(coarse, size->width, size->height);
    return coarse;
}

// h with -laplace(h) = 1 inside of a silhouette (1 there, 0 outside, soft between), a pixel as unit: r^2 / 4
// in the middle of a disk. Successive over-relaxation, in order of rows: one thread, so that the bits are the
// same. 0 beyond the edges.
Image blown_up(const Image& silhouette) {
    const auto longest = float(std::max(silhouette.width, silhouette.height));
    const float relaxation = 2.0f / (1.0f + 3.14159265f / longest);
    Image h = make_image(silhouette.width, silhouette.height, 1);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (std::int64_t y = 0; y < h.height; ++y) {
            for (std::int64_t x = 0; x < h.width; ++x) {
                const float left = x > 0 ? *h.at(x - 1, y) : 0.0f;
                const float right = x + 1 < h.width ? *h.at(x + 1, y) : 0.0f;
                const float up = y > 0 ? *h.at(x, y - 1) : 0.0f;
                const float down = y + 1 < h.height ? *h.at(x, y + 1) : 0.0f;
                const float inside = *silhouette.at(x, y);
                const float level = (left + right + up + down + inside) / (4.0f + leak * (1.0f - inside));
                float& here = *h.at(x, y);
                here += relaxation * (level - here);
            }
        }
    }
    return h;
}

}  // namespace

Image balloon_of(const Image& brightest) { return blown_up(silhouette_of(silhouette_grid(brightest).light)); }

Image shell_field(const Image& brightest, Image shell, double depth, double steepest) {
    const SilhouetteGrid grid = silhouette_grid(brightest);
    const float highest = std::ranges::max(shell.pixels);
    if (highest <= 0.0f) return to_field_size(std::move(shell), grid);
    change_each(shell, [&](float v) { return float(depth) * std::sqrt(std::max(0.0f, v) / highest); });
    shell = to_field_size(std::move(shell), grid);
    limit_slope(shell, steepest * field_step(brightest));
    return gaussian_blur(shell, shell_blur * double(shell.width));
}

namespace {

// Found on M42, the Red Spider and Sh2-106: cores are taken, filaments and rims are not.
constexpr double line_length = 0.2;  // of the width
constexpr double share_blur = 0.01;  // of the width; lines leave straight edges
constexpr int opening_angles = 12;
constexpr double share_from = 0.15, share_to = 0.45;  // that the opening takes away
constexpr double least_light = 0.5;                   // of what is bright, that a core has
constexpr double rim = 0.015;                         // of the width; a core's steep edges are its own
constexpr float roundness = 0.9f;                     // depth of a core over its width

// Values along lines, each the least or the greatest of those within `half` steps. Beyond the edges: as
// there.
Image along_lines(const Image& image, double dx, double dy, int half, bool least) {
    Image out = unfilled_image(image.width, image.height, 1);
    for (std::int64_t y = 0; y < image.height; ++y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            float value = *image.at(x, y);
            for (int step = -half; step <= half; ++step) {
                const std::int64_t u =
                    std::clamp<std::int64_t>(x + std::llround(step * dx), 0, image.width - 1);
                const std::int64_t v =
                    std::clamp<std::int64_t>(y + std::llround(step * dy), 0, image.height - 1);
                value = least ? std::min(value, *image.at(u, v)) : std::max(value, *image.at(u, v));
            }
            *out.at(x, y) = value;
        }
    }
    return out;
}

Image opened_by_lines(const Image& image) {
    const int half = std::max(1, int(std::llround(0.5 * line_length * double(image.width))));
    std::vector<Image> opened(opening_angles);
    parallel_each(opened.size(), 1, [&](std::size_t i) {
        const double angle = real::pi * double(i) / opening_angles;
        const double dx = real::cos(angle), dy = real::sin(angle);
        opened[i] = along_lines(along_lines(image, dx, dy, half, true), dx, dy, half, false);
    });
    for (std::size_t i = 1; i < opened.size(); ++i)
        std::ranges::transform(opened[0].pixels, opened[i].pixels, opened[0].pixels.begin(),
                               [](float a, float b) { return std::max(a, b); });
    return opened[0];
}

// The greatest of the pixels at most `reach` px away.
Image grown(const Image& image, std::int64_t reach) {
    Image out = image;
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        for_each_about(image, x, y, reach, [&](std::int64_t u, std::int64_t v) {
            if ((u - x) * (u - x) + (v - y) * (v - y) <= reach * reach + 1)
                *out.at(x, y) = std::max(*out.at(x, y), *image.at(u, v));
        });
    });
    return out;
}

}  // namespace

FilledLight find_filled_light(const Image& brightest) {
    const SilhouetteGrid grid = silhouette_grid(brightest);
    const Image around = opened_by_lines(grid.light);
    const double bright = std::max(1e-12, field_percentile(grid.light, bright_percentile));
    Image share = grid.light, sky = silhouette_of(grid.light);
    for (std::size_t i = 0; i < share.pixels.size(); ++i) {
        const double light = double(grid.light.pixels[i]);
        const double away = 1.0 - double(around.pixels[i]) / std::max(1e-12, light);
        share.pixels[i] = float(smooth(share_from, share_to, away) *
                                smooth(0.5 * least_light, least_light, light / bright));
    }
    const auto width = double(share.width);
    Image reach = blown_up(gaussian_blur(share, share_blur * width));
    share = gaussian_blur(grown(share, std::llround(rim * width)), share_blur * width);
    const float texels = float(brightest.width) / float(share.width);
    change_each(reach, [&](float v) { return roundness * 2.0f * texels * std::sqrt(std::max(0.0f, v)); });
    limit_slope(reach, double(texels));  // or a core would have a cliff all around
    change_each(sky, [](float v) { return 1.0f - v; });
    return {to_field_size(share, grid), to_field_size(sky, grid), to_field_size(reach, grid)};
}

}  // namespace astrosplat
