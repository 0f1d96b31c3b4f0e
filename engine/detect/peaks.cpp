// Heights are sums with Gaussian and with equal weights, both along rows, then along columns.
#include "detect/peaks.h"

#include "core/real.h"
#include "image/blur.h"
#include "image/channels.h"

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
            const double t = double(i) / sigma, w = real::exp(-0.5 * t * t);
            weights.push_back(float(w));
            sum += w;
            squares += w * w;
        }
        const double count = double(weights.size() * weights.size());
        mean = sum * sum / count;
        variance = squares * squares - sum * sum * sum * sum / count;
    }
    std::int64_t radius() const { return std::int64_t(weights.size() / 2); }
};

struct TwoSums {
    float weighted = 0.0f, plain = 0.0f;
};

// Along rows: channel 0 weighted, channel 1 plain. Beyond the edges the last pixel goes on.
Image row_sums(const Image& brightness, const Kernel& kernel) {
    Image sums = make_image(brightness.width, brightness.height, 2);
    const std::int64_t radius = kernel.radius(), width = brightness.width;
    parallel_each(brightness.height, rows_per_chunk, [&](std::int64_t y) {
        std::vector<float> padded(std::size_t(width + 2 * radius));
        for (std::int64_t i = -radius; i < width + radius; ++i)
            padded[i + radius] = *brightness.at(std::clamp<std::int64_t>(i, 0, width - 1), y);
        for (std::int64_t x = 0; x < width; ++x) {
            TwoSums s;
            for (std::size_t k = 0; k < kernel.weights.size(); ++k) {
                const float value = padded[std::size_t(x) + k];
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
        return double(*heights.at(std::clamp<std::int64_t>(i, 0, heights.width - 1),
                                  std::clamp<std::int64_t>(j, 0, heights.height - 1)));
    };
    const double height = at(x, y);
    return {double(x) + 0.5 + peak_offset(at(x - 1, y), height, at(x + 1, y)),
            double(y) + 0.5 + peak_offset(at(x, y - 1), height, at(x, y + 1)), height, noise};
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
            sum_x += light * double(i);
            sum_y += light * double(j);
        }
    }
    const double least = std::max(sum, 1e-12);
    return {sum, float(double(x) + 0.5 + sum_x / least), float(double(y) + 0.5 + sum_y / least)};
}

Image matched_heights(const Image& brightness, double sigma_px) {
    const Kernel kernel(sigma_px);
    const Image sums = row_sums(brightness, kernel);
    Image heights = make_image(brightness.width, brightness.height, 1);
    const std::int64_t radius = kernel.radius();
    const auto mean = float(kernel.mean), scale = float(1.0 / kernel.variance);
    parallel_each(heights.height, rows_per_chunk, [&](std::int64_t y) {
        float* const row = heights.at(0, y);
        for (std::int64_t k = -radius; k <= radius; ++k) {
            const float weight = kernel.weights[k + radius];
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
    for (float& noise : cells.noise.pixels) noise = std::max(noise, float(least));
    return cells;
}

std::vector<StarCandidate> find_candidates(const Image& heights, const Cells& noise, double threshold) {
    return found_by_rows(heights, 0, [&](std::int64_t x, std::int64_t y) -> std::optional<StarCandidate> {
        const float height = *heights.at(x, y);
        if (!(height > 0.0f)) return {};
        const double around = interpolated(noise.noise, noise.cell_px, double(x) + 0.5, double(y) + 0.5, 0);
        if (!(height > threshold * around) || !is_peak(heights, x, y, peak_reach_px)) return {};
        return candidate_at(heights, x, y, around);
    });
}

namespace {

// Differences of Gaussians of such a ratio are nearly Laplacians (Marr and Hildreth 1980).
constexpr double finest_sigma_px = 1.6;
constexpr double sigma_ratio = 1.6;
constexpr int scales = 4;
constexpr float prominence = 1.5f;        // times the mean contrast around it
constexpr float least_contrast = 0.006f;  // of the displayed white
constexpr float reach_sigmas = 3.0f;
constexpr float soft_rim = 0.4f;  // of the reach, over which the weight falls to 0

struct Peak {
    Knot knot;
    float contrast;
};

Image difference(const Image& a, const Image& b) {
    Image out = unfilled_image(a.width, a.height, 1);
    parallel_each(out.pixels.size(), 65536,
                  [&](std::size_t i) { out.pixels[i] = a.pixels[i] - b.pixels[i]; });
    return out;
}

Image magnitude(Image image) {
    parallel_each(image.pixels.size(), 65536,
                  [&](std::size_t i) { image.pixels[i] = std::fabs(image.pixels[i]); });
    return image;
}

// The curvature of the contrast along what is seen there over that across.
float curvature_ratio(const Image& contrast, std::int64_t x, std::int64_t y, std::int64_t step) {
    const auto at = [&](std::int64_t i, std::int64_t j) { return *contrast.at(x + i * step, y + j * step); };
    const float xx = at(1, 0) + at(-1, 0) - 2.0f * at(0, 0), yy = at(0, 1) + at(0, -1) - 2.0f * at(0, 0);
    const float xy = 0.25f * (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1));
    const float mean = 0.5f * (xx + yy), apart = std::sqrt(0.25f * (xx - yy) * (xx - yy) + xy * xy);
    return (mean + apart) / std::min(-1e-12f, mean - apart);
}

// Peaks of one scale, in order of rows.
std::vector<Peak> peaks(const Image& contrast, double sigma) {
    const Image common = gaussian_blur(magnitude(contrast), 12.0 + 4.0 * sigma);
    const auto reach = std::int64_t(std::ceil(1.2 * sigma));
    return found_by_rows(contrast, reach, [&](std::int64_t x, std::int64_t y) -> std::optional<Peak> {
        const float here = *contrast.at(x, y);
        if (here < least_contrast || here < prominence * *common.at(x, y)) return {};
        if (!is_peak(contrast, x, y, reach, EqualPeaks::all)) return {};
        const float ratio = curvature_ratio(contrast, x, y, std::max<std::int64_t>(1, reach / 2));
        const Knot knot{float(x) + 0.5f, float(y) + 0.5f, float(sigma),
                        std::clamp((ratio - 0.1f) / 0.2f, 0.0f, 1.0f),
                        std::clamp((ratio - 0.5f) / 0.25f, 0.0f, 1.0f)};
        return Peak{knot, here};
    });
}

// Gives the knot the pixels within its reach, where no other has a greater claim.
void claim(const Knot& knot, std::int32_t index, const Image& image, Knots& out) {
    const float reach = reach_sigmas * knot.sigma;
    const auto whole = [](float v) { return std::int64_t(std::floor(v)); };
    const auto take = [&](std::int64_t x, std::int64_t y) {
        const float dx = float(x) + 0.5f - knot.x, dy = float(y) + 0.5f - knot.y;
        const float inside = 1.0f - std::sqrt(dx * dx + dy * dy) / reach;
        const float weight = std::clamp(inside / soft_rim, 0.0f, 1.0f);
        const std::int64_t at = y * image.width + x;
        if (weight <= out.weight[at]) return;
        out.weight[at] = weight;
        out.owner[at] = index;
    };
    for_each_between(image, whole(knot.x - reach), whole(knot.y - reach), whole(knot.x + reach),
                     whole(knot.y + reach), take);
}

}  // namespace

Knots find_knots(const Image& brightest, const std::vector<Knot>& given) {
    std::vector<Peak> peaks_found;
    double sigma = finest_sigma_px;
    Image finer = gaussian_blur(brightest, sigma);
    for (int scale = 0; scale < scales; ++scale) {
        Image coarser = gaussian_blur(finer, sigma * std::sqrt(sigma_ratio * sigma_ratio - 1.0));
        const std::vector<Peak> found = peaks(difference(finer, coarser), sigma);
        peaks_found.insert(peaks_found.end(), found.begin(), found.end());
        finer = std::move(coarser);
        sigma *= sigma_ratio;
    }
    std::ranges::stable_sort(peaks_found, std::greater(), &Peak::contrast);
    Knots result{brightest.width, brightest.height, {}, {}, {}};
    const std::int64_t pixels = brightest.width * brightest.height;
    result.owner.assign(pixels, -1);
    result.weight.assign(pixels, 0.0f);
    const auto add = [&](const Knot& knot) {
        claim(knot, std::int32_t(result.knots.size()), brightest, result);
        result.knots.push_back(knot);
    };
    for (const Knot& knot : given) add(knot);
    for (const Peak& peak : peaks_found) {
        const Knot& knot = peak.knot;
        const std::int64_t at = std::int64_t(knot.y) * brightest.width + std::int64_t(knot.x);
        if (!(result.weight[at] > 0.5f)) add(knot);
    }
    return result;
}

}  // namespace astrosplat
