// Sums with Gaussian and with equal weights, both along rows, then along columns.
#include "prepare/star_finder.h"

#include <algorithm>
#include <cassert>
#include <cmath>

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

bool is_greatest(const Image& heights, std::int64_t x, std::int64_t y) {
    const float here = *heights.at(x, y);
    for (std::int64_t j = std::max<std::int64_t>(0, y - peak_reach_px);
         j <= std::min(heights.height - 1, y + peak_reach_px); ++j) {
        for (std::int64_t i = std::max<std::int64_t>(0, x - peak_reach_px);
             i <= std::min(heights.width - 1, x + peak_reach_px); ++i) {
            const bool earlier = j < y || (j == y && i < x);
            if (*heights.at(i, j) > here || (earlier && *heights.at(i, j) == here)) return false;
        }
    }
    return true;
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

Image mean_of_channels(const Image& image) {
    assert(image.channels >= 3);
    Image mean = make_image(image.width, image.height, 1);
    parallel_each(image.height, rows_per_chunk, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            const float* const p = image.at(x, y);
            *mean.at(x, y) = (p[0] + p[1] + p[2]) / 3.0f;
        }
    });
    return mean;
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
    std::vector<std::vector<StarCandidate>> rows(static_cast<std::size_t>(heights.height));
    parallel_each(heights.height, rows_per_chunk, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < heights.width; ++x) {
            const float height = *heights.at(x, y);
            if (!(height > 0.0f)) continue;
            const double around = interpolated(noise.noise, noise.cell_px, static_cast<double>(x) + 0.5,
                                               static_cast<double>(y) + 0.5, 0);
            if (height > threshold * around && is_greatest(heights, x, y))
                rows[static_cast<std::size_t>(y)].push_back(candidate_at(heights, x, y, around));
        }
    });
    std::vector<StarCandidate> candidates;
    for (const auto& row : rows) candidates.insert(candidates.end(), row.begin(), row.end());
    return candidates;
}

}  // namespace astrosplat
