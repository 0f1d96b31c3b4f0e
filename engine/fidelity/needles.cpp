#include "fidelity/needles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "fidelity/display.h"
#include "image/blur.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr std::size_t most_points = 400;
constexpr std::int64_t edge_px = 12, peak_reach_px = 4;
constexpr std::int64_t reach_px = 9, side_px = 2 * reach_px + 1;  // of the square around a point
constexpr float least_height = 1e-4f;  // of white: below, peaks are those of rounding
constexpr double needle_elongation = 1.6;
constexpr double pixel_variance = 0.08;  // px^2, so that a single pixel has a width (about 1/12)
constexpr float background_share = 0.35f;

struct Peak {
    std::int64_t x, y;
    float height;
};

// Of equal neighbours the first from the top left is the peak.
bool is_peak(const Image& image, std::int64_t x, std::int64_t y) {
    const float height = *image.at(x, y);
    if (height < least_height) return false;
    for (std::int64_t j = y - peak_reach_px; j <= y + peak_reach_px; ++j)
        for (std::int64_t i = x - peak_reach_px; i <= x + peak_reach_px; ++i) {
            const bool before = j < y || (j == y && i < x);
            if (*image.at(i, j) > height || (before && *image.at(i, j) == height)) return false;
        }
    return true;
}

// The strongest first; of equal ones the first from the top left.
std::vector<Peak> strongest_peaks(const Image& image) {
    std::vector<std::vector<Peak>> of_row(static_cast<std::size_t>(image.height));
    parallel_each(image.height, 16, [&](std::int64_t y) {
        if (y < edge_px || y >= image.height - edge_px) return;
        for (std::int64_t x = edge_px; x < image.width - edge_px; ++x)
            if (is_peak(image, x, y)) of_row[static_cast<std::size_t>(y)].push_back({x, y, *image.at(x, y)});
    });
    std::vector<Peak> peaks;
    for (const std::vector<Peak>& row : of_row) peaks.insert(peaks.end(), row.begin(), row.end());
    std::stable_sort(peaks.begin(), peaks.end(),
                     [](const Peak& a, const Peak& b) { return a.height > b.height; });
    if (peaks.size() > most_points) peaks.resize(most_points);
    return peaks;
}

using Square = std::array<float, static_cast<std::size_t>(side_px* side_px)>;

// What stands out of the surroundings of a point, 0 elsewhere.
Square standing_out(const Image& brightness, const Peak& peak) {
    Square square;
    for (std::int64_t j = 0; j < side_px; ++j)
        std::copy_n(brightness.at(peak.x - reach_px, peak.y + j - reach_px), side_px,
                    square.data() + j * side_px);
    Square sorted = square;
    const auto middle = sorted.begin() + sorted.size() / 2;
    std::nth_element(sorted.begin(), middle, sorted.end());
    const float center = *brightness.at(peak.x, peak.y);
    const float floor = *middle + background_share * (center - *middle);
    for (float& value : square) value = std::max(value - floor, 0.0f);
    return square;
}

// Keeps what is connected with the middle, side by side; false where there is nothing.
bool keep_connected(Square& square) {
    Square kept{};
    std::vector<std::int64_t> open;
    const auto visit = [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        if (square[k] <= 0.0f || kept[k] > 0.0f) return;
        kept[k] = square[k];
        open.push_back(i);
    };
    visit(reach_px * side_px + reach_px);
    const bool any = !open.empty();
    while (!open.empty()) {
        const std::int64_t i = open.back(), x = i % side_px;
        open.pop_back();
        if (x > 0) visit(i - 1);
        if (x + 1 < side_px) visit(i + 1);
        if (i >= side_px) visit(i - side_px);
        if (i + side_px < side_px * side_px) visit(i + side_px);
    }
    square = kept;
    return any;
}

// Length from top to bottom over width; nothing where the point does not stand out.
std::optional<double> elongation(const Image& brightness, const Peak& peak) {
    Square square = standing_out(brightness, peak);
    if (!keep_connected(square)) return std::nullopt;
    double sum = 0.0, x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
    for (std::int64_t i = 0; i < side_px * side_px; ++i) {
        const double w = square[static_cast<std::size_t>(i)];
        const auto x = static_cast<double>(i % side_px - reach_px),
                   y = static_cast<double>(i / side_px - reach_px);
        sum += w;
        x1 += w * x;
        y1 += w * y;
        x2 += w * x * x;
        y2 += w * y * y;
    }
    const double vx = x2 / sum - (x1 / sum) * (x1 / sum), vy = y2 / sum - (y1 / sum) * (y1 / sum);
    return std::sqrt((vy + pixel_variance) / (vx + pixel_variance));
}

}  // namespace

Needles needles(const Image& side_view) {
    const Image brightness = display_max(side_view);
    Image detail = convolved_with_gaussian(brightness, 1.0);
    const Image surroundings = convolved_with_gaussian(brightness, 7.0);
    for (std::size_t i = 0; i < detail.pixels.size(); ++i) detail.pixels[i] -= surroundings.pixels[i];
    Needles result;
    int long_ones = 0;
    for (const Peak& peak : strongest_peaks(detail)) {
        const std::optional<double> e = elongation(brightness, peak);
        if (!e) continue;
        ++result.points;
        long_ones += *e > needle_elongation;
    }
    if (result.points > 0) result.share = static_cast<double>(long_ones) / result.points;
    return result;
}

Needles flat_needles(const Image& picture) {
    const PixelMap half_as_high{{}, {1.0, 0.0, 0.0, 2.0}};
    return needles(resampled(picture, half_as_high, picture.width, picture.height / 2, 0.5));
}

}  // namespace astrosplat
