#include "detect/knots.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "detect/peaks.h"
#include "image/blur.h"

namespace astrosplat {
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
    parallel_chunks(out.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * out.width; i < end * out.width; ++i)
            out.pixels[static_cast<std::size_t>(i)] =
                a.pixels[static_cast<std::size_t>(i)] - b.pixels[static_cast<std::size_t>(i)];
    });
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
    const auto reach = static_cast<std::int64_t>(std::ceil(1.2 * sigma));
    return found_by_rows(contrast, reach, [&](std::int64_t x, std::int64_t y) -> std::optional<Peak> {
        const float here = *contrast.at(x, y);
        if (here < least_contrast || here < prominence * *common.at(x, y)) return {};
        if (!is_peak(contrast, x, y, reach, EqualPeaks::all)) return {};
        const float ratio = curvature_ratio(contrast, x, y, std::max<std::int64_t>(1, reach / 2));
        const Knot knot{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, static_cast<float>(sigma),
                        std::clamp((ratio - 0.1f) / 0.2f, 0.0f, 1.0f),
                        std::clamp((ratio - 0.5f) / 0.25f, 0.0f, 1.0f)};
        return Peak{knot, here};
    });
}

// Gives the knot the pixels within its reach, where no other has a greater claim.
void claim(const Knot& knot, std::int32_t index, const Image& image, Knots& out) {
    const float reach = reach_sigmas * knot.sigma;
    const auto first = [](float v) {
        return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(v)));
    };
    const std::int64_t x_end = std::min(image.width, first(knot.x + reach) + 1);
    const std::int64_t y_end = std::min(image.height, first(knot.y + reach) + 1);
    for (std::int64_t y = first(knot.y - reach); y < y_end; ++y) {
        for (std::int64_t x = first(knot.x - reach); x < x_end; ++x) {
            const float dx = static_cast<float>(x) + 0.5f - knot.x,
                        dy = static_cast<float>(y) + 0.5f - knot.y;
            const float inside = 1.0f - std::sqrt(dx * dx + dy * dy) / reach;
            const float weight = std::clamp(inside / soft_rim, 0.0f, 1.0f);
            const auto at = static_cast<std::size_t>(y * image.width + x);
            if (weight <= out.weight[at]) continue;
            out.weight[at] = weight;
            out.owner[at] = index;
        }
    }
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
    std::stable_sort(peaks_found.begin(), peaks_found.end(),
                     [](const Peak& a, const Peak& b) { return a.contrast > b.contrast; });
    Knots result;
    const auto pixels = static_cast<std::size_t>(brightest.width * brightest.height);
    result.owner.resize(pixels);
    result.weight.resize(pixels);
    parallel_each(pixels, 65536, [&](std::size_t i) {
        result.owner[i] = -1;
        result.weight[i] = 0.0f;
    });
    for (const Knot& knot : given) {
        claim(knot, static_cast<std::int32_t>(result.knots.size()), brightest, result);
        result.knots.push_back(knot);
    }
    for (const Peak& peak : peaks_found) {
        const Knot& knot = peak.knot;
        const auto at = static_cast<std::size_t>(static_cast<std::int64_t>(knot.y) * brightest.width +
                                                 static_cast<std::int64_t>(knot.x));
        if (result.weight[at] > 0.5f) continue;
        claim(knot, static_cast<std::int32_t>(result.knots.size()), brightest, result);
        result.knots.push_back(knot);
    }
    return result;
}

}  // namespace astrosplat
