#include "detect/background.h"

#include "core/parallel.h"
#include "core/sorting.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr int most_clips = 5;
constexpr double clip = 3.0;                     // times the noise
constexpr std::int64_t most_values_a_side = 48;  // larger cells are looked at in steps

// Clipped until nothing changes; nothing of no values.
Background clipped_background(std::vector<float> values) {
    Background found;
    for (int i = 0; i < most_clips && !values.empty(); ++i) {
        found = background_of(values);
        const float most = float(clip) * found.noise();
        const auto far = [&](float value) { return std::fabs(value - found.level) > most; };
        const std::size_t before = values.size();
        if (found.noise() > 0.0f) std::erase_if(values, far);
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
    for_each_pixel(cells, [&](std::int64_t x, std::int64_t y) {
        for (int c = 0; c < cells.channels; ++c) {
            std::vector<float> around;
            for_each_about(cells, x, y, 1,
                           [&](std::int64_t i, std::int64_t j) { around.push_back(cells.at(i, j)[c]); });
            out.at(x, y)[c] = median(around);
        }
    });
    return out;
}

constexpr std::size_t window_px = (2 * median_reach_px + 1) * (2 * median_reach_px + 1);

// The value with `rank` smaller ones, of values >= 0, whose bits are in the same order: found bit by bit,
// which takes a third of the time of a partial sort.
float value_of_rank(const std::array<std::int32_t, window_px>& bits, std::int32_t rank) {
    std::int32_t found = 0;
    for (int bit = 30; bit >= 0; --bit) {
        const std::int32_t candidate = found | std::int32_t{1} << bit;
        std::int32_t smaller = 0;
        for (const std::int32_t value : bits) smaller += value < candidate ? 1 : 0;
        if (smaller <= rank) found = candidate;
    }
    return std::bit_cast<float>(found);
}

}  // namespace

Background background_of(std::vector<float>& values) {
    const float level = median(values);
    std::vector<float> away(values.size());
    std::ranges::transform(values, away.begin(), [&](float value) { return std::fabs(value - level); });
    return {level, median(away)};
}

float median_about(const Image& image, std::int64_t x, std::int64_t y) {
    std::array<std::int32_t, window_px> bits;
    std::size_t count = 0;
    for_each_about(image, x, y, median_reach_px, [&](std::int64_t i, std::int64_t j) {
        bits[count++] = std::bit_cast<std::int32_t>(*image.at(i, j));
    });
    std::fill(bits.begin() + std::ptrdiff_t(count), bits.end(), std::numeric_limits<std::int32_t>::max());
    return value_of_rank(bits, std::int32_t(count / 2));
}

Cells measure_cells(const Image& image, std::int64_t cell_px) {
    const std::int64_t columns = (image.width + cell_px - 1) / cell_px;
    const std::int64_t rows = (image.height + cell_px - 1) / cell_px;
    Image level = make_image(columns, rows, image.channels), noise = level;
    parallel_each(columns * rows, 4, [&](std::int64_t i) {
        const std::int64_t x = i % columns * cell_px, y = i / columns * cell_px;
        const Region cell{x, y, std::min(cell_px, image.width - x), std::min(cell_px, image.height - y)};
        for (int c = 0; c < image.channels; ++c) {
            const Background found = clipped_background(values_of(image, cell, c));
            level.at(i % columns, i / columns)[c] = found.level;
            noise.at(i % columns, i / columns)[c] = found.noise();
        }
    });
    return {cell_px, median_of_nine(level), median_of_nine(noise)};
}

double interpolated(const Image& cells, std::int64_t cell_px, double x, double y, int channel) {
    const auto place = [cell_px](double at, std::int64_t n) {
        return std::clamp(at / double(cell_px) - 0.5, 0.0, double(n - 1));
    };
    const double u = place(x, cells.width), v = place(y, cells.height);
    const auto i = std::int64_t(u), j = std::int64_t(v);
    const std::int64_t right = std::min(i + 1, cells.width - 1), below = std::min(j + 1, cells.height - 1);
    const double s = u - double(i), t = v - double(j);
    const auto value = [&](std::int64_t a, std::int64_t b) { return double(cells.at(a, b)[channel]); };
    return (value(i, j) * (1.0 - s) + value(right, j) * s) * (1.0 - t) +
           (value(i, below) * (1.0 - s) + value(right, below) * s) * t;
}

}  // namespace astrosplat
