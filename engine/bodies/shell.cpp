#include "bodies/shell.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bodies/fields.h"
#include "core/sorting.h"
#include "image/blur.h"

namespace astrosplat {
namespace {

constexpr std::int64_t longest_grid = 128;         // px, on which the equation is solved
constexpr double silhouette_blur = 20.0 / 1920.0;  // of the width
constexpr double sky_percentile = 0.02, bright_percentile = 0.96;
constexpr double silhouette_from = 0.04, silhouette_to = 0.13;  // of the range between them: its soft edge
constexpr float leak = 4.0f;                                    // outside of it, by which h falls off
constexpr int sweeps = 400;

}  // namespace

SilhouetteGrid silhouette_grid(const Image& brightest) {
    SilhouetteGrid grid{brightest, {}};
    for (int i = 0; i < field_halvings(brightest); ++i) grid.light = halved(grid.light);
    grid.light = gaussian_blur(grid.light, silhouette_blur * static_cast<double>(grid.light.width));
    while (std::max(grid.light.width, grid.light.height) > longest_grid) {
        grid.finer.push_back({grid.light.width, grid.light.height});
        grid.light = halved(grid.light);
    }
    return grid;
}

Image silhouette_of(Image light) {
    const std::vector<double> values{light.pixels.begin(), light.pixels.end()};
    const double sky = percentile(values, sky_percentile);
    const double range = std::max(1e-12, percentile(values, bright_percentile) - sky);
    for (float& value : light.pixels) {
        const double share = (static_cast<double>(value) - sky) / range;
        const double t = std::clamp((share - silhouette_from) / (silhouette_to - silhouette_from), 0.0, 1.0);
        value = static_cast<float>(t * t * (3.0 - 2.0 * t));
    }
    return light;
}

Image to_field_size(Image coarse, const SilhouetteGrid& grid) {
    for (auto size = grid.finer.rbegin(); size != grid.finer.rend(); ++size)
        coarse = doubled(coarse, size->width, size->height);
    return coarse;
}

// Successive over-relaxation, in order of rows: one thread, so that the bits are the same. 0 beyond the
// edges.
Image blown_up(const Image& silhouette) {
    const auto longest = static_cast<float>(std::max(silhouette.width, silhouette.height));
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

Image shell_field(const Image& brightest, double depth, double steepest) {
    SilhouetteGrid grid = silhouette_grid(brightest);
    Image shell = blown_up(silhouette_of(grid.light));
    const float highest = *std::max_element(shell.pixels.begin(), shell.pixels.end());
    if (highest > 0.0f)
        for (float& value : shell.pixels)
            value = static_cast<float>(depth) * std::sqrt(std::max(0.0f, value) / highest);
    shell = to_field_size(std::move(shell), grid);
    if (highest <= 0.0f) return shell;
    limit_slope(shell, steepest * static_cast<double>(1 << field_halvings(brightest)));
    return gaussian_blur(shell, 0.005 * static_cast<double>(shell.width));  // takes corners off
}

}  // namespace astrosplat
