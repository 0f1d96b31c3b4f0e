// Heights are sums with Gaussian and with equal weights, both along rows, then along columns.
#include "detect/peaks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_per_chunk = 16;
constexpr std::int64_t noise_cell_px = 48;
constexpr std::int64_t peak_reach_px = 2;

// The Gaussian along one axis, and what the least squares of height and background need of its square.
struct Kernel {
    std::vector<float> weights;
    double mean = 0.0;      // over the square
    double variance = 0.0;  // sum of squares about it

    explicit Kernel(double sigma) {
        const auto radius = std::max<std::int64_t>(2, std::llround(std::ceil(2.0 * sigma)));
        double sum = 0.0, squares = 0.0;
        for (std::int64_t i = -radius; i <= radius; ++i) {
            const double t = static_cast<double>(i) / sigma, w = real::exp(-0.5 * t * t);
            weights.push_back(static_cast<float>(w));
            sum += w;
            squares += w * w;
        }
        const double count = static_cast<double>(weights.size() * weights.size());
        mean = sum * sum / count;
        variance = squares * squares - sum * sum * sum * sum / count;
    }
    std::int64_t radius() const { return static_cast<std::int64_t>(weights.size() / 2); }
};

struct TwoSums {
    float weighted = 0.0f, plain = 0.0f;
};

// Along rows: channel 0 weighted, channel 1 plain. Beyond the edges the last pixel goes on.
Image row_sums(const Image& brightness, const Kernel& kernel) {
    Image sums = make_image(brightness.width, brightness.height, 2);
    const std::int64_t radius = kernel.radius(), width = brightness.width;
    parallel_each(brightness.height, rows_per_chunk, [&](std::int64_t y) {
        std::vector<float> padded(static_cast<std::size_t>(width + 2 * radius));
        for (std::int64_t i = -radius; i < width + radius; ++i)
            padded[static_cast<std::size_t>(i + radius)] =
                *brightness.at(std::clamp<std::int64_t>(i, 0, width - 1), y);
        for (std::int64_t x = 0; x < width; ++x) {
            TwoSums s;
            for (std::size_t k = 0; k < kernel.weights.size(); ++k) {
                const float value = padded[static_cast<std::size_t>(x) + k];
                s.weighted += kernel.weights[k] * value;
                s.plain += value;
            }
            sums.at(x, y)[0] = s.weighted;
            sums.at(x, y)[1] = s.plain;
        }
    });
    return sums;
}

// Where the parabola through three heights is greatest, px from the middle one.
double peak_offset(double before, double here, double after) {
    const double bend = before - 2.0 * here + after;
    return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

StarCandidate candidate_at(const Image& heights, std::int64_t x, std::int64_t y, double noise) {
    const auto at = [&](std::int64_t i, std::int64_t j) {
        return static_cast<double>(*heights.at(std::clamp<std::int64_t>(i, 0, heights.width - 1),
                                               std::clamp<std::int64_t>(j, 0, heights.height - 1)));
    };
    const double height = at(x, y);
    return {static_cast<double>(x) + 0.5 + peak_offset(at(x - 1, y), height, at(x + 1, y)),
            static_cast<double>(y) + 0.5 + peak_offset(at(x, y - 1), height, at(x, y + 1)), height, noise};
}

}  // namespace

bool is_peak(const Image& heights, std::int64_t x, std::int64_t y, std::int64_t reach_px, EqualPeaks equal) {
    const float here = *heights.at(x, y);
    const std::int64_t left = std::max<std::int64_t>(0, x - reach_px),
                       right = std::min(heights.width - 1, x + reach_px);
    for (std::int64_t j = std::max<std::int64_t>(0, y - reach_px);
         j <= std::min(heights.height - 1, y + reach_px); ++j) {
        for (std::int64_t i = left; i <= right; ++i) {
            const float there = *heights.at(i, j);
            const bool earlier = j < y || (j == y && i < x);
            if (there > here || (there == here && earlier && equal == EqualPeaks::first)) return false;
        }
    }
    return true;
}

PointLight light_about(const Image& brightest, std::int64_t x, std::int64_t y, std::int64_t reach_px,
                       float floor) {
    double sum = 0.0, sum_x = 0.0, sum_y = 0.0;
    for (std::int64_t j = -reach_px; j <= reach_px; ++j) {
        for (std::int64_t i = -reach_px; i <= reach_px; ++i) {
            const double light = std::max(0.0f, *brightest.at(x + i, y + j) - floor);
            sum += light;
            sum_x += light * static_cast<double>(i);
            sum_y += light * static_cast<double>(j);
        }
    }
    const double least = std::max(sum, 1e-12);
    return {sum, static_cast<float>(static_cast<double>(x) + 0.5 + sum_x / least),
            static_cast<float>(static_cast<double>(y) + 0.5 + sum_y / least)};
}

Image matched_heights(const Image& brightness, double sigma_px) {
    const Kernel kernel(sigma_px);
    const Image sums = row_sums(brightness, kernel);
    Image heights = make_image(brightness.width, brightness.height, 1);
    const std::int64_t radius = kernel.radius();
    const auto mean = static_cast<float>(kernel.mean), scale = static_cast<float>(1.0 / kernel.variance);
    parallel_each(heights.height, rows_per_chunk, [&](std::int64_t y) {
        float* const row = heights.at(0, y);
        for (std::int64_t k = -radius; k <= radius; ++k) {
            const float weight = kernel.weights[static_cast<std::size_t>(k + radius)];
            const float* const from = sums.at(0, std::clamp<std::int64_t>(y + k, 0, heights.height - 1));
            for (std::int64_t x = 0; x < heights.width; ++x)
                row[x] += (weight * from[2 * x] - mean * from[2 * x + 1]) * scale;
        }
    });
    return heights;
}

double pixel_noise_over_height_noise(double sigma_px) { return std::sqrt(Kernel(sigma_px).variance); }

Cells noise_of_heights(const Image& heights, double least) {
    Cells cells = measure_cells(heights, noise_cell_px);
    for (float& noise : cells.noise.pixels) noise = std::max(noise, static_cast<float>(least));
    return cells;
}

std::vector<StarCandidate> find_candidates(const Image& heights, const Cells& noise, double threshold) {
    return found_by_rows(heights, 0, [&](std::int64_t x, std::int64_t y) -> std::optional<StarCandidate> {
        const float height = *heights.at(x, y);
        if (!(height > 0.0f)) return {};
        const double around = interpolated(noise.noise, noise.cell_px, static_cast<double>(x) + 0.5,
                                           static_cast<double>(y) + 0.5, 0);
        if (!(height > threshold * around) || !is_peak(heights, x, y, peak_reach_px)) return {};
        return candidate_at(heights, x, y, around);
    });
}

}  // namespace astrosplat
