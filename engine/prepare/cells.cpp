// Sorted values of each cell, clipped until nothing changes.
#include "prepare/cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr int most_clips = 5;
constexpr double clip = 3.0;                     // times the noise
constexpr double sigma_of_deviation = 1.4826;    // standard deviation over median deviation
constexpr std::int64_t most_values_a_side = 48;  // larger cells are looked at in steps

float middle_of(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Statistics {
    float level = 0.0f, noise = 0.0f;
};

Statistics statistics_of(std::vector<float> values) {
    Statistics found;
    if (values.empty()) return found;
    std::vector<float> away;
    for (int i = 0; i < most_clips; ++i) {
        found.level = middle_of(values);
        away.clear();
        for (const float value : values) away.push_back(std::fabs(value - found.level));
        found.noise = static_cast<float>(sigma_of_deviation * static_cast<double>(middle_of(away)));
        const float most = static_cast<float>(clip) * found.noise;
        const auto far = [&](float value) { return std::fabs(value - found.level) > most; };
        const std::size_t before = values.size();
        if (found.noise > 0.0f) std::erase_if(values, far);
        if (values.size() == before) break;
    }
    return found;
}

std::vector<float> values_of(const Image& image, const Region& cell, int channel) {
    const std::int64_t step = (std::max(cell.width, cell.height) - 1) / most_values_a_side + 1;
    std::vector<float> values;
    for (std::int64_t y = cell.y; y < cell.y + cell.height; y += step)
        for (std::int64_t x = cell.x; x < cell.x + cell.width; x += step)
            if (std::isfinite(image.at(x, y)[channel])) values.push_back(image.at(x, y)[channel]);
    return values;
}

Image median_of_nine(const Image& cells) {
    Image out = make_image(cells.width, cells.height, cells.channels);
    for (std::int64_t y = 0; y < cells.height; ++y) {
        for (std::int64_t x = 0; x < cells.width; ++x) {
            for (int c = 0; c < cells.channels; ++c) {
                std::vector<float> around;
                for (std::int64_t j = std::max<std::int64_t>(0, y - 1);
                     j <= std::min(cells.height - 1, y + 1); ++j)
                    for (std::int64_t i = std::max<std::int64_t>(0, x - 1);
                         i <= std::min(cells.width - 1, x + 1); ++i)
                        around.push_back(cells.at(i, j)[c]);
                out.at(x, y)[c] = middle_of(around);
            }
        }
    }
    return out;
}

}  // namespace

Cells measure_cells(const Image& image, std::int64_t cell_px) {
    const std::int64_t columns = (image.width + cell_px - 1) / cell_px;
    const std::int64_t rows = (image.height + cell_px - 1) / cell_px;
    Image level = make_image(columns, rows, image.channels), noise = level;
    parallel_each(columns * rows, 4, [&](std::int64_t i) {
        const std::int64_t x = i % columns * cell_px, y = i / columns * cell_px;
        const Region cell{x, y, std::min(cell_px, image.width - x), std::min(cell_px, image.height - y)};
        for (int c = 0; c < image.channels; ++c) {
            const Statistics found = statistics_of(values_of(image, cell, c));
            level.at(i % columns, i / columns)[c] = found.level;
            noise.at(i % columns, i / columns)[c] = found.noise;
        }
    });
    return {cell_px, median_of_nine(level), median_of_nine(noise)};
}

double interpolated(const Image& cells, std::int64_t cell_px, double x, double y, int channel) {
    const auto place = [cell_px](double at, std::int64_t n) {
        return std::clamp(at / static_cast<double>(cell_px) - 0.5, 0.0, static_cast<double>(n - 1));
    };
    const double u = place(x, cells.width), v = place(y, cells.height);
    const auto i = static_cast<std::int64_t>(u), j = static_cast<std::int64_t>(v);
    const std::int64_t right = std::min(i + 1, cells.width - 1), below = std::min(j + 1, cells.height - 1);
    const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
    const auto value = [&](std::int64_t a, std::int64_t b) {
        return static_cast<double>(cells.at(a, b)[channel]);
    };
    return (value(i, j) * (1.0 - s) + value(right, j) * s) * (1.0 - t) +
           (value(i, below) * (1.0 - s) + value(right, below) * s) * t;
}

}  // namespace astrosplat
