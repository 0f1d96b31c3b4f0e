// The built-in relief: brightness, smoothed, as the height of a grid.
#include "source/relief.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/color.h"
#include "core/real.h"
#include "source/sample.h"

namespace astrosplat {
namespace {

constexpr std::int64_t cells = 256;      // along the longer side
constexpr double blur_of_longer = 0.02;  // standard deviation of the smoothing, of the longer side

// One value per grid vertex, columns x rows, row 0 on top.
struct Heights {
    std::int64_t columns, rows;
    std::vector<double> values;

    double& at(std::int64_t x, std::int64_t y) { return values[y * columns + x]; }
};

// What the eye sees as brightness: the display value of the luminance, each vertex averaging the texels of
// one cell.
Heights brightness(const Texture& texture, std::int64_t columns, std::int64_t rows) {
    Texture lookup;
    lookup.image = texture.image;
    lookup.filter = TextureSettings::Filter::area;
    lookup.wrap = TextureSettings::Wrap::clamp;
    const glm::vec2 box(static_cast<float>(texture.image.width) / static_cast<float>(columns - 1),
                        static_cast<float>(texture.image.height) / static_cast<float>(rows - 1));
    Heights heights{columns, rows, std::vector<double>(columns * rows)};
    for (std::int64_t y = 0; y < rows; ++y) {
        for (std::int64_t x = 0; x < columns; ++x) {
            const glm::vec2 uv(static_cast<float>(x) / static_cast<float>(columns - 1),
                               1.0f - static_cast<float>(y) / static_cast<float>(rows - 1));
            const TextureSample s = sample(lookup, uv, box);
            const float light = luminance(s.color.x, s.color.y, s.color.z) * s.alpha;
            heights.at(x, y) = real::linear_to_srgb(std::min(light, 1.0f));
        }
    }
    return heights;
}

// One pass of a separable gaussian; the edge values continue outside.
void blur(Heights& heights, double sigma, bool along_x) {
    const auto reach = static_cast<std::int64_t>(std::ceil(3.0 * sigma));
    std::vector<double> weight;
    double total = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        weight.push_back(real::exp(-0.5 * static_cast<double>(k * k) / (sigma * sigma)));
        total += weight.back();
    }
    Heights from = heights;
    for (std::int64_t y = 0; y < heights.rows; ++y) {
        for (std::int64_t x = 0; x < heights.columns; ++x) {
            double sum = 0.0;
            for (std::int64_t k = -reach; k <= reach; ++k) {
                const std::int64_t sx = along_x ? std::clamp<std::int64_t>(x + k, 0, heights.columns - 1) : x;
                const std::int64_t sy = along_x ? y : std::clamp<std::int64_t>(y + k, 0, heights.rows - 1);
                sum += weight[k + reach] * from.at(sx, sy);
            }
            heights.at(x, y) = sum / total;
        }
    }
}

// The brightest place is 1, so that `height` means what it says for dark pictures too.
void normalise(Heights& heights) {
    const double most = *std::ranges::max_element(heights.values);
    if (!(most > 0.0)) return;
    for (double& value : heights.values) value /= most;
}

std::int64_t cells_along(double part_of_longer) {
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(cells * part_of_longer + 0.5)));
}

}  // namespace

Mesh relief_mesh(const Texture& texture, double height) {
    assert(texture.image.width > 0 && texture.image.height > 0);
    const double aspect =
        static_cast<double>(texture.image.width) / static_cast<double>(texture.image.height);
    const std::int64_t columns = cells_along(std::min(1.0, aspect)) + 1;
    const std::int64_t rows = cells_along(std::min(1.0, 1.0 / aspect)) + 1;
    Heights heights = brightness(texture, columns, rows);
    blur(heights, blur_of_longer * cells, true);
    blur(heights, blur_of_longer * cells, false);
    normalise(heights);
    const double width = aspect >= 1.0 ? 10.0 : 10.0 * aspect, depth = width / aspect;
    Mesh mesh;
    mesh.name = "relief";
    for (std::int64_t y = 0; y < rows; ++y) {
        for (std::int64_t x = 0; x < columns; ++x) {
            const double u = static_cast<double>(x) / static_cast<double>(columns - 1);
            const double down = static_cast<double>(y) / static_cast<double>(rows - 1);
            mesh.positions.emplace_back((u - 0.5) * width, heights.at(x, y) * height * width,
                                        (down - 0.5) * depth);
            mesh.uvs.emplace_back(u, 1.0 - down);
        }
    }
    for (std::int64_t y = 0; y + 1 < rows; ++y) {
        for (std::int64_t x = 0; x + 1 < columns; ++x) {
            const auto d = static_cast<std::uint32_t>(y * columns + x),
                       a = static_cast<std::uint32_t>(d + columns);
            mesh.triangles.push_back({{a, a + 1, d + 1}, {a, a + 1, d + 1}, 0});
            mesh.triangles.push_back({{a, d + 1, d}, {a, d + 1, d}, 0});
        }
    }
    return mesh;
}

}  // namespace astrosplat
