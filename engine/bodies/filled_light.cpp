#include "bodies/filled_light.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bodies/fields.h"
#include "bodies/surfaces.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "image/blur.h"

namespace astrosplat {
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
    const int half =
        std::max(1, static_cast<int>(std::llround(0.5 * line_length * static_cast<double>(image.width))));
    std::vector<Image> opened(opening_angles);
    parallel_for(opening_angles, [&](std::int64_t i, int) {
        const double angle = real::pi * static_cast<double>(i) / opening_angles;
        const double dx = real::cos(angle), dy = real::sin(angle);
        opened[static_cast<std::size_t>(i)] =
            along_lines(along_lines(image, dx, dy, half, true), dx, dy, half, false);
    });
    for (std::size_t i = 1; i < opened.size(); ++i)
        for (std::size_t k = 0; k < opened[0].pixels.size(); ++k)
            opened[0].pixels[k] = std::max(opened[0].pixels[k], opened[i].pixels[k]);
    return opened[0];
}

// The greatest of the pixels at most `reach` px away.
Image grown(const Image& image, std::int64_t reach) {
    Image out = image;
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x)
            for (std::int64_t v = std::max<std::int64_t>(0, y - reach);
                 v <= std::min(image.height - 1, y + reach); ++v)
                for (std::int64_t u = std::max<std::int64_t>(0, x - reach);
                     u <= std::min(image.width - 1, x + reach); ++u)
                    if ((u - x) * (u - x) + (v - y) * (v - y) <= reach * reach + 1)
                        *out.at(x, y) = std::max(*out.at(x, y), *image.at(u, v));
    return out;
}

double smooth(double from, double to, double value) {
    return real::smoothstep(std::clamp((value - from) / (to - from), 0.0, 1.0));
}

}  // namespace

FilledLight find_filled_light(const Image& brightest) {
    const SilhouetteGrid grid = silhouette_grid(brightest);
    const Image around = opened_by_lines(grid.light);
    const double bright =
        std::max(1e-12, percentile({grid.light.pixels.begin(), grid.light.pixels.end()}, 0.96));
    Image share = grid.light, sky = silhouette_of(grid.light);
    for (std::size_t i = 0; i < share.pixels.size(); ++i) {
        const double light = static_cast<double>(grid.light.pixels[i]);
        const double away = 1.0 - static_cast<double>(around.pixels[i]) / std::max(1e-12, light);
        share.pixels[i] = static_cast<float>(smooth(share_from, share_to, away) *
                                             smooth(0.5 * least_light, least_light, light / bright));
    }
    const auto width = static_cast<double>(share.width);
    Image reach = blown_up(gaussian_blur(share, share_blur * width));
    share = gaussian_blur(grown(share, std::llround(rim * width)), share_blur * width);
    const float texels = static_cast<float>(brightest.width) / static_cast<float>(share.width);
    for (float& value : reach.pixels) value = roundness * 2.0f * texels * std::sqrt(std::max(0.0f, value));
    limit_slope(reach, static_cast<double>(texels));  // or a core would have a cliff all around
    for (float& value : sky.pixels) value = 1.0f - value;
    return {to_field_size(share, grid), to_field_size(sky, grid), to_field_size(reach, grid)};
}

}  // namespace astrosplat
